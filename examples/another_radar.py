"""The same person and room seen by two radars, and the radar that one makes oneself."""

from dataclasses import replace

from mmweaver import PRESETS, Weaver

fine = replace(PRESETS["awr1843"], name="awr1843 with 64 loops", num_loops=64)
for radar in ("hupr", fine):
    weaver = Weaver(radar=radar)
    result = weaver.generate(weaver.sample_room(), "a person walks", frames=3, seed=1)
    config = result.cube.config
    print(f"{config.name}: {result.cube.values.shape}, {config.velocity_resolution_mps:.3f} m/s a bin")
