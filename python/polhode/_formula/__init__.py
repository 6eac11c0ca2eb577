"""Formulas as on paper."""
