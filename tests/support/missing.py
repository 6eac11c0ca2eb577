"""What to do where something is missing that a test needs."""

import os

import pytest


def left_out(reason):
    """Skip what needs something that is missing, unless every test must run."""
    (pytest.fail if os.environ.get("POLHODE_EVERY_TEST") else pytest.skip)(reason)
