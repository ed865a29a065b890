"""Rolling resistance of a line contact: laws beside a numerical solution."""
