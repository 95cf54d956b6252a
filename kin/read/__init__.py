"""Files as numbers, whoever wrote them."""
