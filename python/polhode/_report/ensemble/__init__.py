"""The run of a scene with many bodies and what is reported of it."""
