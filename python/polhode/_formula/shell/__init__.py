"""Formulas line by line: the commands and the notebook magic."""
