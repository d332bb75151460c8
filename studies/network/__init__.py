"""The learned method against physics, oracles and baselines."""
