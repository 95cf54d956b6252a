"""Formulas as a recipe writes them: parsed, differentiated, bounded."""
