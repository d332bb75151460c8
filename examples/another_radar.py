"""One person and one room, seen by two radars."""

# %% [markdown]
# A radar is a frozen dataclass in SI units; every resolution follows from its chirp. Presets, TI `.cfg` files and
# configurations of your own are used alike. Twice the loops resolve velocity twice as finely.

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

from mmweaver import PRESETS, Weaver
from mmweaver.signal.spectra import range_doppler_power

finer = replace(PRESETS["awr1843"], name="awr1843, 64 loops", num_loops=64)
fig, axes = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
for radar, panel in zip((PRESETS["awr1843"], finer), axes, strict=True):
    weaver = Weaver(radar=radar)
    result = weaver.generate(weaver.sample_room(), "a person waves with both hands", frames=6, seed=1)
    config, grid = result.cube.config, result.cube.grid
    print(f"{config.name}: {result.cube.values.shape}, {config.velocity_resolution_mps:.3f} m/s per Doppler bin")
    power = range_doppler_power(result.cube)[4]
    extent = (grid.radial_velocity_mps[0], grid.radial_velocity_mps[-1], grid.range_m[0], grid.range_m[-1])
    decibels = 10 * np.log10(power / power.max())
    panel.imshow(decibels, origin="lower", aspect="auto", extent=extent, vmin=-60, cmap="inferno")
    panel.set(xlabel="radial velocity (m/s)", ylabel="range (m)", title=config.name)
fig.savefig("two_radars.png", dpi=110)
