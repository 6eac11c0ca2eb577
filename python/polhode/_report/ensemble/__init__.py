"""Runs of scenes with many bodies, and their reports."""
