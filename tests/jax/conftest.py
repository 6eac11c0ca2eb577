"""Fixtures of the tests under JAX."""

import pytest


@pytest.fixture(autouse=True)
def _doubles():
    """64 bits in all threads; `jax.enable_x64` holds for one, and JAX runs callbacks in others."""
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", False)
