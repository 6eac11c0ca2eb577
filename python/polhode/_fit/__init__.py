"""Fits: the body and its motion from measured attitudes and rates."""
