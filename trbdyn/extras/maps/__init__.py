"""Maps over speed, load and temperature: friction torque, slip, the cage's whirl, and answers about one cage."""
