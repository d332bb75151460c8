"""A signal as a continuous function: fitted, sampled more finely, augmented, compressed."""

# %% [markdown]
# A field is a function f(frame, range, Doppler, antenna) -> I + jQ with few values: the paper's implicit neural
# representation, or scatterers. Each of the paper's uses of it is one method call.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from mmweaver import Weaver
from mmweaver.inr import FitOptions, fit, load

weaver = Weaver()
cube = weaver.generate(weaver.sample_room(), "a person walks to the right", frames=4, seed=2).cube
# or a recording: mmweaver.read_recording("adc_data.bin", radar="profile.cfg").cube


def error_db(values: np.ndarray) -> float:
    return 10 * np.log10(np.sum(np.abs(values - cube.values) ** 2) / np.sum(np.abs(cube.values) ** 2))


# %%
curve: list[tuple[int, float]] = []
inr = fit(cube, num_values=2_000, options=FitOptions(steps=200), progress=lambda step, _, db: curve.append((step, db)))
scatterers = fit(cube, "scatterers", num_values=2_000)
for name, field in (("modulated INR", inr), ("scatterers", scatterers)):
    print(f"{name}: {field.num_values:,} values for {2 * cube.values.size:,}, {error_db(field.cube().values):.1f} dB")

# %% [markdown]
# Super-resolution samples between the bins: every second cell is an original one. Jitter is the paper's augmentation.

# %%
finer = inr.on_grid(n_r=2, n_d=2)
moved = inr.jitter(radius=2 / 8, seed=1)
print("finer:", finer.values.shape, "moved:", moved.values.shape)
assert finer.values.shape[1] == 2 * cube.values.shape[1]

# %% [markdown]
# A field is stored as safetensors, its values once; the file is the compressed signal.

# %%
inr.save("walk.safetensors")
again = load("walk.safetensors")
assert np.array_equal(again.cube().values, inr.cube().values)
print(f"{Path('walk.safetensors').stat().st_size:,} bytes for {cube.values.nbytes:,}")

# %%
fig, axes = plt.subplots(1, 3, figsize=(10, 3), layout="constrained")
for axis, shown, title in zip(axes, (cube, finer), ("signal", "field, twice as fine"), strict=False):
    power = (np.abs(shown.values[2]) ** 2).mean(-1)
    axis.imshow(10 * np.log10(power / power.max() + 1e-6), origin="lower", aspect="auto", vmin=-50)
    axis.set(title=title, xlabel="Doppler bin", ylabel="range bin")
axes[2].plot(*zip(*curve, strict=True))
axes[2].set(title="fit of the INR", xlabel="step", ylabel="error energy (dB)")
fig.savefig("field.png", dpi=110)
