"""Multivectors, rotors and their algebra."""
