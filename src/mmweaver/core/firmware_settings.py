"""Point-cloud settings from the .cfg of TI's out-of-box demo: CFAR, peak grouping, clutter removal, beamforming."""

from dataclasses import dataclass, replace

from mmweaver.core.errors import InputError

AVERAGE_MODES = ("ca", "cago", "caso")  # 0, 1, 2 of cfarCfg
DEVICES = ("xwr14xx", "xwr16xx")
MAX_OBJECTS, MAX_OBJECTS_3D = 100, 64  # list sizes of the demo; elevation antennas leave memory for fewer objects
SDK3_MAX_OBJECTS = 500  # in both detection chains of SDK 3, hardware accelerator and DSP


@dataclass(frozen=True, kw_only=True)
class FirmwareCfar:
    """One `cfarCfg` line of TI's demo.

    Attributes:
        average: Averaging mode: "ca", "cago" or "caso".
        window: Averaging window in bins.
        guard: Guard cells in bins.
        noise_shift: The noise sum of both sides is shifted right by this; a single side ("cago", "caso") by one less.
        cyclic: Whether the window wraps around at the ends.
        threshold: Threshold in the device's counts, see `FirmwareSettings`.

    Raises:
        InputError: If the demo would reject the settings.
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
    """Detection settings of TI's out-of-box demo.

    Attributes:
        device: Arithmetic of the detection matrix. "xwr14xx" (IWR1443): sum of log2 magnitudes in Q9 divided by the
            next power of two of the number of antennas; the CFAR window counts both sides. "xwr16xx" (also 18xx and
            68xx of SDK 2): undivided sum in Q8; the window counts one side. 15 dB are 1280 or, with eight antennas,
            5120.
        range_cfar: CFAR in range; None skips the test.
        doppler_cfar: CFAR in Doppler; None skips the test.
        group_range: Whether neighbouring detections in range are grouped into peaks.
        group_doppler: The same in Doppler.
        first_range_bin: First bin of the device's range FFT (next power of two of the samples) that is searched.
        last_range_bin: Last bin that is searched.
        static_removal: Whether static clutter is removed.
        second_peak: Share of the highest azimuth peak above which a second peak is reported as well; None disables it.
        most_objects: Maximum number of objects per frame; None keeps the limit of SDK 1 and 2.
        substitute: Sentence on the detection chain that these settings stand in for; "" for the out-of-box demo.

    Raises:
        InputError: If a setting is impossible.
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
    most_objects: int | None = None
    substitute: str = ""

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
        """Replaces the threshold of the range CFAR.

        Args:
            threshold: Threshold in counts; None keeps the present one.

        Returns:
            The new settings; unchanged without a range CFAR.
        """
        if threshold is None or self.range_cfar is None:
            return self
        return replace(self, range_cfar=replace(self.range_cfar, threshold=round(threshold)))


# SDK 3 out-of-box demo for boards with three transmitters: 15 dB in range and in Doppler, one object per peak.
SDK3_COUNTS = 7654  # 15 dB for twelve antennas in Q8
SDK3 = FirmwareSettings(
    device="xwr16xx",
    range_cfar=FirmwareCfar(average="caso", window=8, guard=4, noise_shift=4, threshold=SDK3_COUNTS),
    doppler_cfar=FirmwareCfar(average="ca", window=4, guard=2, noise_shift=3, cyclic=True, threshold=SDK3_COUNTS),
    most_objects=SDK3_MAX_OBJECTS,
)

# By radar preset. RadHAR: its recordings are grouped in Doppler but not in range; threshold and clutter removal follow
# the 3D profile. MARS: its recordings lack static points, so clutter removal was on, and contain neighbouring bins in
# range and Doppler, so grouping was off; the rest follows the 3D profile.
FIRMWARE = {
    "iwr1443_radhar": FirmwareSettings(group_range=False),
    "iwr6843isk": SDK3,
    "iwr6843aop": SDK3,
    "iwr6843ods": SDK3,
    "iwr1443_mars": FirmwareSettings(static_removal=True, group_range=False, group_doppler=False),
}
