"""The rows of the table of numbers, by what they are of: the run, the cage, contacts, ratings, losses."""
