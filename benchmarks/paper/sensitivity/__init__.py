"""How the cage's motion depends on the inputs that the paper does not give.

``python benchmarks/paper/sensitivity`` changes one input at a time, at several operating points and over several seeds, and tells
the effect on each indicator beside the scatter over seeds. `inputs` lists what is changed and why by so much, `plan` makes the
runs, `indicators` reads them, `effects` compares them, `picture` and `report` show them.
"""
