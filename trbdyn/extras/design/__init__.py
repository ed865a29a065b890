"""Designs: the best ones within limits, what matters for them, stand-ins for runs, and plans of runs."""
