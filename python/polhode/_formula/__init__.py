"""Formulas in the notation of the handout."""
