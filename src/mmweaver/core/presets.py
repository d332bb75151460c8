"""Radar presets. Chirps from the sources named; antenna positions from the boards' data sheets."""

from dataclasses import replace
from typing import Any

from mmweaver.core.antenna_tables import AOP, BOOST, BOOST_1642, EVM_2944, ISK, ODS, AntennaTable, Places
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import Position, RadarConfig
from mmweaver.core.registry import Registry


def halfwave_positions(places: Places, centre_frequency_hz: float) -> tuple[Position, ...]:
    """(x, z) in half wavelengths at a frequency -> (x, y, z) in metres, y = 0."""
    half_m = SPEED_OF_LIGHT_MPS / centre_frequency_hz / 2
    return tuple((x * half_m, 0.0, z * half_m) for x, z in places)


BAND_77_HZ = (76.0e9, 81.0e9)
BAND_60_HZ = (57.0e9, 64.0e9)


def ti_1843(name: str, **chirp: Any) -> RadarConfig:
    """A board with the xWR1843's 3 x 4 array, spaced half a wavelength at the centre of the chirp given."""
    return ti_board(name, BOOST, **{"tx_order": (0, 2, 1), **chirp})


def ti_board(name: str, board: AntennaTable, **chirp: Any) -> RadarConfig:
    """A board with this array, spaced half a wavelength at the centre of the chirp given."""
    values: dict[str, Any] = {
        "start_frequency_hz": 77.0e9,
        "frame_period_s": 0.1,
        "tx_order": tuple(range(len(board.tx_halfwaves))),
        "frequency_limits_hz": BAND_77_HZ,
        "rx_inverted": board.rx_inverted,
        **chirp,
    }
    sampled_s = values["num_samples"] / values["sample_rate_hz"]
    middle_hz = values["start_frequency_hz"] + values["chirp_slope_hz_per_s"] * (
        values["adc_start_time_s"] + sampled_s / 2
    )
    return RadarConfig(
        name=name,
        tx_position_m=halfwave_positions(board.tx_halfwaves, middle_hz),
        rx_position_m=halfwave_positions(board.rx_halfwaves, middle_hz),
        **values,
    )


# The paper gives 77 GHz, 3 TX and 4 RX, 4.4 cm, 64 x 32 x 12 at 10 fps; its chirp is not published. The slope and
# the times are mmMesh's, the sample rate the one that makes 256 samples 4.4 cm. Bins 16 to 79 are 0.70 to 3.48 m.
AWR1843 = ti_1843(
    "awr1843",
    chirp_slope_hz_per_s=60.012e12,
    idle_time_s=7e-6,
    adc_start_time_s=6e-6,
    ramp_end_time_s=65e-6,
    num_samples=256,
    sample_rate_hz=4.51e6,
    num_loops=32,
    first_range_bin=16,
)

# mmMesh configuration.py and RF-Genesis TI1843_config.json agree.
MMMESH = ti_1843(
    "mmmesh",
    chirp_slope_hz_per_s=60.012e12,
    idle_time_s=7e-6,
    adc_start_time_s=6e-6,
    ramp_end_time_s=65e-6,
    num_samples=256,
    sample_rate_hz=4.4e6,
    num_loops=128,
    first_range_bin=25,
    num_range_bins=101,
)

RF_GENESIS = replace(MMMESH, name="rf_genesis")

# HuPR publishes 256 samples, 64 loops, 10 fps, bins 31 to 94 and transmitters in the order 0, 1, 2; its slope and
# sample rate are not published, TI's best-range-resolution profile is assumed.
HUPR = ti_1843(
    "hupr",
    chirp_slope_hz_per_s=70.0e12,
    idle_time_s=267e-6,
    adc_start_time_s=7e-6,
    ramp_end_time_s=57.14e-6,
    num_samples=256,
    sample_rate_hz=5.209e6,
    num_loops=64,
    first_range_bin=31,
    tx_order=(0, 1, 2),
)

# mmWave Studio set-up of a public IWR6843ISK recording (3.9 cm bins).
IWR6843 = ti_1843(
    "iwr6843",
    start_frequency_hz=60.0e9,
    chirp_slope_hz_per_s=29.837e12,
    idle_time_s=280e-6,
    adc_start_time_s=6e-6,
    ramp_end_time_s=134e-6,
    num_samples=512,
    sample_rate_hz=4.0e6,
    num_loops=85,
    frame_period_s=0.15,
    first_range_bin=16,
    tx_order=(0, 1, 2),
    frequency_limits_hz=BAND_60_HZ,
)

# IWR1443BOOST of the RadHAR recordings. Their places lie on steps of 4.09 cm, their driver's range on 4.36 cm: TI's 3D
# profile, whose 240 samples at 4.884 Msps (4.36 cm) fill a 256-bin FFT. 16 loops of 0.615 m/s and 30 frames a second
# ask for the shortest idle time; all but the frame rate and that are the SDK's profile_3d.cfg. Unknown: receiver gain
# (30 dB as in the profile), beam (the board's data sheet has +-25 degrees in azimuth at -6 dB, as the xWR1843's).
IWR1443_RADHAR = ti_1843(
    "iwr1443_radhar",
    chirp_slope_hz_per_s=70.0e12,
    idle_time_s=7e-6,
    adc_start_time_s=7e-6,
    ramp_end_time_s=57.14e-6,
    num_samples=240,
    sample_rate_hz=4.884e6,
    num_loops=16,
    frame_period_s=1 / 30,
    num_range_bins=126,
    lvds_lanes=4,
)

# IWR1443BOOST of the MARS recordings. Measured on them: range steps of 2.93 cm, velocity steps of 0.356 m/s (nothing
# beyond 1.42 m/s), azimuth on 64 bins, elevation, 10 frames a second. So sample rate over slope is 0.05 us (for a
# 256-bin FFT), and loops times loop period 5.3 ms. Unknown: how these share out; taken are the 3D profile's slope and
# ramp, as many samples as fit, and 16 loops.
IWR1443_MARS = ti_1843(
    "iwr1443_mars",
    chirp_slope_hz_per_s=70.0e12,
    idle_time_s=53.6e-6,
    adc_start_time_s=7e-6,
    ramp_end_time_s=57.14e-6,
    num_samples=168,
    sample_rate_hz=3.5e6,
    num_loops=16,
    first_range_bin=10,
    lvds_lanes=4,
)

# Boards with the chirp of a recording or of TI's own profiles, so that every array is at hand: the 6843 boards with
# the indoor profile of TI's 3D People Tracking (60.75 GHz, 54.71 MHz/us, 96 samples at 2.95 Msps, 96 loops every
# 55 ms), the 77 GHz boards with the awr1843's chirp. All range bins are kept.
PEOPLE_TRACKING: dict[str, Any] = {
    "start_frequency_hz": 60.75e9, "chirp_slope_hz_per_s": 54.71e12, "idle_time_s": 30e-6, "adc_start_time_s": 25e-6,
    "ramp_end_time_s": 59.1e-6, "num_samples": 96, "sample_rate_hz": 2.95e6, "num_loops": 96,
    "frame_period_s": 55e-3, "num_range_bins": 96, "frequency_limits_hz": BAND_60_HZ,
}  # fmt: skip
SHORT_CHIRP: dict[str, Any] = {
    "chirp_slope_hz_per_s": 60.012e12, "idle_time_s": 7e-6, "adc_start_time_s": 6e-6, "ramp_end_time_s": 65e-6,
    "num_samples": 256, "sample_rate_hz": 4.51e6, "num_loops": 32, "num_range_bins": 256,
}  # fmt: skip
IWR6843_ISK = ti_board("iwr6843isk", ISK, **PEOPLE_TRACKING)
IWR6843_AOP = ti_board("iwr6843aop", AOP, **PEOPLE_TRACKING)
IWR6843_ODS = ti_board("iwr6843ods", ODS, **PEOPLE_TRACKING)
XWR1443 = ti_board("xwr1443boost", BOOST, tx_order=(0, 2, 1), lvds_lanes=4, **SHORT_CHIRP)
XWR1642 = ti_board("xwr1642boost", BOOST_1642, **SHORT_CHIRP)
AWR2944 = ti_board("awr2944evm", EVM_2944, tx_order=(0, 2, 3, 1), **SHORT_CHIRP)

# Infineon BGT60TR13C: 58 to 63.5 GHz in 64 real samples; receivers in an L, its corner the third. Receiver spacing
# and sides are from the data sheet's drawing, unconfirmed by a recording.
BGT60 = RadarConfig(
    name="bgt60",
    start_frequency_hz=58.0e9,
    chirp_slope_hz_per_s=5.5e9 / 32e-6,
    idle_time_s=559.125e-6,
    adc_start_time_s=0.0,
    ramp_end_time_s=32e-6,
    num_samples=64,
    sample_rate_hz=2.0e6,
    num_loops=8,
    frame_period_s=77.2688e-3,
    tx_position_m=((0.0, 0.0, 0.0),),
    rx_position_m=halfwave_positions(((1.0, 0.0), (0.0, 1.0), (0.0, 0.0)), 60.75e9),
    tx_order=(0,),
    complex_samples=False,
    lvds_lanes=0,
    num_range_bins=32,
    tx_power_dbm=5.0,
    antenna_gain_dbi=5.0,
    noise_figure_db=12.0,
    azimuth_beamwidth_deg=75.0,
    elevation_beamwidth_deg=75.0,
    frequency_limits_hz=BAND_60_HZ,
)

PRESETS: Registry[RadarConfig] = Registry(
    "radar preset",
    [
        (config.name, config)
        for config in (
            AWR1843,
            MMMESH,
            RF_GENESIS,
            HUPR,
            IWR6843,
            IWR1443_RADHAR,
            IWR1443_MARS,
            BGT60,
            IWR6843_ISK,
            IWR6843_AOP,
            IWR6843_ODS,
            XWR1443,
            XWR1642,
            AWR2944,
        )
    ],
    entry_points="mmweaver.radars",
)
