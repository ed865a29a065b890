"""The paper's operating points, run until they settle, with its figures and a table of its statements.

Sakaguchi, T., Harada, K., Dynamic analysis of cage behavior in a tapered roller bearing, ASME J. Tribology 128 (2006) 604-611.
`python benchmarks/paper -o FOLDER` does everything; `points` lists what is run, `settle` runs it, `point_numbers` reads it,
`figures` draws it, `statements` judges it.
"""
