"""Exit codes of the command."""

OK, FAILED, USAGE, BAD_INPUT, DRIFTED, INTERRUPTED = 0, 1, 2, 3, 4, 130
