"""One room, several sentences: a small labelled data set."""

# %% [markdown]
# The photo is read and reconstructed once. Each sentence then costs a fraction of a second, and the micro-Doppler of
# the activities differs: a label comes with every signal, and so does the true skeleton.

# %%
import matplotlib.pyplot as plt
import numpy as np

from mmweaver import Weaver
from mmweaver.signal.spectra import range_doppler_power

sentences = ("a person walks to the left", "someone waves with both hands", "a man squats twice", "a person falls")
weaver = Weaver()
room = weaver.sample_room()
fig, axes = plt.subplots(1, 4, figsize=(12, 3), sharey=True, layout="constrained")
for seed, (text, panel) in enumerate(zip(sentences, axes, strict=True)):
    result = weaver.generate(room, text, frames=30, seed=seed)
    result.save(f"sequences/{seed}", pictures=False)
    grid = result.cube.grid
    doppler = range_doppler_power(result.cube).sum(axis=1)  # (frame, doppler)
    extent = (grid.frame_time_s[0], grid.frame_time_s[-1], grid.radial_velocity_mps[0], grid.radial_velocity_mps[-1])
    decibels = 10 * np.log10(doppler.T / doppler.max())
    panel.imshow(decibels, origin="lower", aspect="auto", extent=extent, vmin=-45, cmap="magma")
    panel.set(xlabel="time (s)", title=text)
    print(
        f"{text}: {len(result.points.frame)} points, pelvis moves {np.ptp(result.pose.joints_m[:, 0], 0).max():.2f} m"
    )
axes[0].set_ylabel("radial velocity (m/s)")
fig.savefig("doppler_time.png", dpi=110)
