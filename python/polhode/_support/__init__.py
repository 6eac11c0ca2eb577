"""Helpers for all other folders: arrays, files, optional libraries and memory."""
