"""A first signal: where the energy is, and where the person is."""

# %% [markdown]
# The bundled room is a photo with depth. The network predicts its echoes and those of a person who walks and waves.

# %%
import matplotlib.pyplot as plt
import numpy as np

from mmweaver import Weaver
from mmweaver.signal.spectra import moving_doppler, range_doppler_power

weaver = Weaver()
room = weaver.sample_room()
result = weaver.generate(room, "a person walks towards the radar, then waves with the left hand", seed=0)

# %% [markdown]
# A cube is complex: (frame, range, doppler, antenna). Its grid says which second, metre and m/s each cell stands for.
# The moving energy follows the skeleton that the signal was generated from.

# %%
cube, grid = result.cube, result.cube.grid
power = range_doppler_power(cube)  # (frame, range, doppler)
moving = power[:, :, moving_doppler(cube)].sum(axis=2)  # (frame, range)
pelvis_m = np.linalg.norm(result.pose.joints_m[:, 0], axis=1)  # (frame,)
seen_m = grid.range_m[moving.argmax(axis=1)]
print(f"cube {cube.values.shape}, {cube.values.dtype}; {len(result.points.frame)} points")
print(f"strongest moving echo within {np.median(np.abs(seen_m - pelvis_m)):.2f} m of the pelvis (median over frames)")

# %%
extent = (grid.frame_time_s[0], grid.frame_time_s[-1], grid.range_m[0], grid.range_m[-1])
decibels = 10 * np.log10(moving.T / moving.max())
fig, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
image = axes.imshow(decibels, origin="lower", aspect="auto", extent=extent, vmin=-40, cmap="inferno")
axes.plot(grid.frame_time_s, pelvis_m, "w--", label="pelvis (ground truth)")
axes.set(xlabel="time (s)", ylabel="range (m)", title="Moving energy over range and time")
axes.legend(loc="upper right", labelcolor="white", facecolor="black")
fig.colorbar(image, label="dB relative to peak")
fig.savefig("range_time.png", dpi=110)
