"""The raw ADC samples, and an FFT of one's own: the range profile of the first chirp."""

import numpy as np

from mmweaver import Weaver

weaver = Weaver(radar="awr1843")
result = weaver.generate(weaver.sample_room(), "a person jumps", frames=2, keep_adc=True)
assert result.adc is not None
chirp = result.adc.samples[0, 0, 0, 0]  # frame, loop, tx, rx
profile = np.abs(np.fft.fft(chirp * np.hanning(len(chirp))))
config = result.adc.config
print(f"strongest echo at {profile.argmax() * config.range_resolution_m:.2f} m")
