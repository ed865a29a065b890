"""Parts of peers.py: what is run, how alternatives are compared, the picture."""
