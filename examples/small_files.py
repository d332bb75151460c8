"""A sequence in a few kilobytes: the .mmw format."""

# %% [markdown]
# A `.mmw` file stores moving scatterers, static clutter and a residual. Its size is yours to choose; the error falls
# with every byte where there is signal, and noise is not stored.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from mmweaver import Weaver
from mmweaver.compression.mmw_codec import compress_cube, errors_db, read_cube, values_of_bytes

weaver = Weaver()
cube = weaver.generate(weaver.sample_room(), "a person walks to the right", frames=5, seed=2).cube
sizes = (1_000, 5_000)
errors = []
for num_bytes in sizes:
    data = compress_cube(cube, num_bytes=num_bytes)
    Path(f"walk_{num_bytes}.mmw").write_bytes(data)
    errors.append(errors_db(values_of_bytes(data), cube))
    print(f"{len(data):5,} bytes, {cube.values.nbytes / len(data):5,.0f} times smaller:", errors[-1])
again = read_cube("walk_5000.mmw", slice(3, 5))  # only these frames are decoded
print("frames 3 and 4:", again.values.shape)
assert np.isfinite(again.values).all()

# %%
fig, axes = plt.subplots(figsize=(6, 3), layout="constrained")
for name in errors[0]:
    axes.plot(sizes, [error[name] for error in errors], "o-", label=name.replace("_", " "))
axes.set(xscale="log", xlabel="bytes for 5 frames", ylabel="error energy (dB)", title="Size and error")
axes.legend()
fig.savefig("size_and_error.png", dpi=110)
