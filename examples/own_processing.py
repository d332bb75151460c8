"""Raw ADC samples, and signal processing of your own."""

# %% [markdown]
# `keep_adc=True` gives the samples that the converter would have written, (frame, loop, tx, rx, sample). Everything
# after that may be yours: here a range profile with a window and an FFT, compared with the cube that mmWeaver makes.

# %%
import matplotlib.pyplot as plt
import numpy as np

from mmweaver import Weaver

weaver = Weaver(radar="awr1843", method="physics")
result = weaver.generate(weaver.sample_room(), "a person walks", frames=2, keep_adc=True)
adc = result.adc
assert adc is not None  # kept
samples = adc.samples[0]  # (loop, tx, rx, sample)
window = np.hanning(samples.shape[-1])
profile = np.abs(np.fft.fft(samples * window)).mean(axis=(0, 1, 2)) / window.sum()  # (sample,)
range_m = np.arange(len(profile)) * adc.config.range_resolution_m
inside = (range_m > 0.5) & (range_m < range_m[-1] - 0.5)  # without the leakage of the transmitters
print(f"strongest echo at {range_m[inside][profile[inside].argmax()]:.2f} m")

# %%
fig, axes = plt.subplots(figsize=(7, 3), layout="constrained")
axes.plot(range_m, 20 * np.log10(profile))
axes.axvspan(result.cube.grid.range_m[0], result.cube.grid.range_m[-1], alpha=0.15, label="range bins of the cube")
axes.set(xlabel="range (m)", ylabel="dB (mW)", title="Range profile, mean over chirps and antennas")
axes.legend()
fig.savefig("range_profile.png", dpi=110)
