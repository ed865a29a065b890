"""Running a scene: options, simulation, its records, watch and checkpoints, case files, estimates of cost, replay of records."""
