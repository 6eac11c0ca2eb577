"""Property tests are the same on every run: derived from the test itself, nothing remembered."""

from hypothesis import settings

settings.register_profile("polhode", derandomize=True, database=None, deadline=None, max_examples=60)
settings.load_profile("polhode")
