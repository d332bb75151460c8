"""Point-cloud settings of a TI out-of-box demo's .cfg: CFAR, peak grouping, clutter removal, beamforming."""

from dataclasses import dataclass, replace

from mmweaver.core.errors import InputError

AVERAGE_MODES = ("ca", "cago", "caso")  # 0, 1, 2 of cfarCfg
DEVICES = ("xwr14xx", "xwr16xx")
MAX_OBJECTS, MAX_OBJECTS_3D = 100, 64  # the demo's lists; an elevated row leaves memory for fewer
SDK3_MAX_OBJECTS = 500  # of both of its detection chains, with the hardware accelerator and on the DSP


@dataclass(frozen=True, kw_only=True)
class FirmwareCfar:
    """One `cfarCfg` line. Lengths in bins; the threshold in the counts of the device (see FirmwareSettings).

    Raises InputError for settings that the demo would reject.
    """

    average: str = "ca"
    window: int = 8
    guard: int = 4
    noise_shift: int = 3
    cyclic: bool = False
    threshold: int = 1280

    def __post_init__(self) -> None:
        if self.average not in AVERAGE_MODES:
            raise InputError(f"CFAR averaging {self.average!r} is unknown; known: {', '.join(AVERAGE_MODES)}")
        if self.window < 2 or self.guard < 0 or not 1 <= self.noise_shift <= 15 or self.threshold < 0:
            raise InputError(
                f"CFAR window {self.window}, guard {self.guard}, noise shift {self.noise_shift} and threshold"
                f" {self.threshold} cannot be; the window needs 2 bins, the shift 1 to 15, the others 0 or above"
            )


@dataclass(frozen=True, kw_only=True)
class FirmwareSettings:
    """The point cloud of a TI out-of-box demo.

    `device` decides how antennas are summed: "xwr14xx" (IWR1443) has the sum of log2 magnitudes in Q9 divided by the
    next power of two of their number, and a CFAR window that counts both sides; "xwr16xx" (and 18xx, 68xx of SDK 2)
    the whole sum in Q8 and a window on either side. So 15 dB are 1280 or, with eight antennas, 5120. A direction
    without a CFAR is not tested. Range bins are those of the device's FFT (the next power of two of the samples).
    `second_peak` is the share of the highest azimuth peak above which a second one is an object too, None = off.
    Raises InputError for an impossible setting.
    """

    device: str = "xwr14xx"
    range_cfar: FirmwareCfar | None = FirmwareCfar(average="caso")
    doppler_cfar: FirmwareCfar | None = None
    group_range: bool = True
    group_doppler: bool = True
    first_range_bin: int = 1
    last_range_bin: int = 229
    static_removal: bool = False
    second_peak: float | None = 0.5
    most_objects: int | None = None  # None = the limit of the demo of SDK 1 and 2

    def __post_init__(self) -> None:
        if self.device not in DEVICES:
            raise InputError(f"firmware of device {self.device!r} is unknown; known: {', '.join(DEVICES)}")
        if self.range_cfar is None and self.doppler_cfar is None:
            raise InputError("the firmware needs a CFAR in range or in Doppler; add a cfarCfg line")
        if not 0 <= self.first_range_bin <= self.last_range_bin:
            raise InputError(f"range bins {self.first_range_bin} to {self.last_range_bin} of peakGrouping are no span")
        if self.second_peak is not None and not 0 < self.second_peak <= 1:
            raise InputError(f"multiObjBeamForming's threshold must lie in 0 to 1, not {self.second_peak:g}")
        if self.most_objects is not None and self.most_objects < 1:
            raise InputError(f"the most objects per frame must be at least 1, not {self.most_objects}")

    def with_threshold(self, threshold: int | float | None) -> "FirmwareSettings":
        """The same with this threshold of the CFAR in range, in counts; None, or no such CFAR, leaves it."""
        if threshold is None or self.range_cfar is None:
            return self
        return replace(self, range_cfar=replace(self.range_cfar, threshold=round(threshold)))


# The out-of-box demo of SDK 3 for boards with three transmitters: 15 dB in range and in Doppler, one object a peak.
SDK3_COUNTS = 7654  # 15 dB of twelve antennas in Q8
SDK3 = FirmwareSettings(
    device="xwr16xx",
    range_cfar=FirmwareCfar(average="caso", window=8, guard=4, noise_shift=4, threshold=SDK3_COUNTS),
    doppler_cfar=FirmwareCfar(average="ca", window=4, guard=2, noise_shift=3, cyclic=True, threshold=SDK3_COUNTS),
    most_objects=SDK3_MAX_OBJECTS,
)

# By radar preset. RadHAR: grouped in Doppler and not in range, as the recordings show; threshold and clutter removal
# are the 3D profile's. MARS: what stands still is missing from the recordings, so clutter removal was on; neighbours in
# range and in Doppler are both there, so grouping was off; the rest is the 3D profile's.
FIRMWARE = {
    "iwr1443_radhar": FirmwareSettings(group_range=False),
    "iwr6843isk": SDK3,
    "iwr6843aop": SDK3,
    "iwr6843ods": SDK3,
    "iwr1443_mars": FirmwareSettings(static_removal=True, group_range=False, group_doppler=False),
}
