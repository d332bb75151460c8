"""Data sets of procedural rooms: plan, generation and storage. Read `dataset_plan` first."""
