"""What a run has given: recorded fields, observables, summary, and the files that hold them."""
