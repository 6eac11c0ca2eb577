"""``python -m polhode``: the command ``polhode``."""

import sys

from polhode._cli.main import main

if __name__ == "__main__":
    sys.exit(main())
