"""Distance and interference between moving plane bodies, proved over the turn, and the metal of printed bodies."""
