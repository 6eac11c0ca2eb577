"""Skip or fail tests whose requirements are missing."""

import os

import pytest


def left_out(reason):
    """Skip a test, or fail it if `POLHODE_EVERY_TEST` is set."""
    (pytest.fail if os.environ.get("POLHODE_EVERY_TEST") else pytest.skip)(reason)
