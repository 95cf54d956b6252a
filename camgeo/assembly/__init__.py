"""Printable bodies: the cam and what it drives, as horizontal plates with places over one turn."""
