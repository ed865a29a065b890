"""What the scripts work_precision.py and scaling.py share: stored states, trajectories compared, timings, pictures."""
