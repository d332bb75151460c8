"""Checks that your own method, radar, detector, activity or encoder works with the rest of mmWeaver.

For the tests of a package that extends mmWeaver: each function raises AssertionError with the reason. See
docs/extend.md.
"""

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PointCloud, PoseSequence, RadarCube, Scene
from mmweaver.models.methods import Signal
from mmweaver.signal.cube import radar_cube
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room

if TYPE_CHECKING:
    from torch import nn

    from mmweaver.models.methods import Method
    from mmweaver.signal.detection import Detector

TEXT = "a person walks towards the radar"
FRAMES = 3


def check_method(method: "Method", *, room: Room | None = None, radar: str | RadarConfig = "awr1843") -> None:
    """Checks a method: shapes, types, and the same bits for the same seed, with and without ADC samples.

    A method may refuse several people or ADC samples by an InputError; any other exception is a failure.

    Args:
        method: The method.
        room: Room for the check; by default the bundled one.
        radar: Radar for the check.

    Raises:
        AssertionError: If the method violates the protocol.
    """

    def checked(scene: Scene, poses: tuple[PoseSequence, ...], config: RadarConfig, **options: Any) -> Signal:
        signal = method(scene, poses, config, **options)
        assert isinstance(signal, Signal), f"a method returns a Signal, not {type(signal).__name__}"
        _check_cube(signal.cube, CubeGrid.of(config, options["num_frames"]), config)
        return signal

    vars(checked)["__signature__"] = inspect.signature(method)  # exposes its optional arguments
    weaver = Weaver(checked, radar)
    room = room or weaver.sample_room()

    def made(text: str | list[str] = TEXT, **asked: Any) -> Generation:
        return weaver.generate(room, text, frames=FRAMES, **asked)

    first, again, _ = made(seed=1), made(seed=1), made(seed=2)
    _equal(first.cube.values, again.cube.values, "the same seed must give the same bits of the cube")
    with_samples = _unless_refused(lambda: made(seed=1, keep_adc=True))
    if with_samples is not None and with_samples.adc is not None:
        _equal(first.cube.values, with_samples.cube.values, "asking for ADC samples must not change the cube")
        _check_samples(with_samples.adc, weaver.radar)
    _unless_refused(lambda: made([TEXT, "a person stands"], seed=1))
    for sentence in first.meta["assumed"]:
        assert isinstance(sentence, str), f"assumptions must be sentences, not {sentence!r}"
        assert "\n" not in sentence, f"an assumption must be one line: {sentence!r}"


def check_radar(config: RadarConfig) -> None:
    """Checks that a radar survives a round trip through its file and that physics can make signals for it.

    Args:
        config: The radar.

    Raises:
        AssertionError: If it does not.
    """
    assert RadarConfig.from_json(config.to_json()) == config, "the radar must come back from its own JSON"
    weaver = Weaver("physics", config)
    made = _unless_refused(lambda: weaver.generate(weaver.sample_room(), "a person stands", frames=1, seed=0))
    assert made is not None, f"nobody finds a place in the range window of {config.name!r} in the sample room"
    _check_cube(made.cube, CubeGrid.of(config, 1), config)


def check_detector(detect: "Detector", *, radar: str | RadarConfig = "awr1843") -> None:
    """Checks a point detector on a simulated signal: a PointCloud within the cube's frames, reproducible.

    Args:
        detect: The detector.
        radar: Radar for the check.

    Raises:
        AssertionError: If the detector violates the protocol.
    """
    weaver = Weaver("physics", radar)
    made = weaver.generate(weaver.sample_room(), TEXT, frames=FRAMES, seed=0, keep_adc=True)
    assert made.adc is not None
    cube = radar_cube(made.adc)
    points, again = detect(cube, made.adc), detect(cube, made.adc)
    assert isinstance(points, PointCloud), f"a detector returns a PointCloud, not {type(points).__name__}"
    columns = ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    sizes = {name: getattr(points, name).shape for name in columns}
    assert len(set(sizes.values())) == 1, f"all columns must have one length, not {sizes}"
    for name in columns:
        assert np.isfinite(getattr(points, name)).all(), f"{name} must be finite"
        _equal(getattr(points, name), getattr(again, name), f"{name} must be the same each time")
    assert np.issubdtype(points.frame.dtype, np.integer), "frame must hold whole numbers"
    inside = (points.frame >= 0) & (points.frame < FRAMES)
    assert inside.all(), f"frame must be 0 to {FRAMES - 1}"


def check_activity(key: str) -> None:
    """Checks a registered activity: its example is parsed as that activity, and the motion is reproducible and smooth.

    Args:
        key: Key of the activity.

    Raises:
        AssertionError: If a check fails.
    """
    from mmweaver.motion.empty_floor import act_out
    from mmweaver.motion.language.activities import BY_KEY
    from mmweaver.motion.language.sentence import parse_sentence

    assert key in BY_KEY, f"there is no activity {key!r}; register it first"
    activity = BY_KEY[key]
    step = parse_sentence(activity.example).steps[-1]
    assert key in (step.lower, step.upper), f"{activity.example!r} is understood as {step.name}, not as {activity.name}"
    pose, again = (act_out(activity.example, duration_s=activity.natural_s + 0.5, seed=1).pose for _ in range(2))
    _equal(pose.joints_m, again.joints_m, "the same seed must give the same motion")
    assert np.isfinite(pose.joints_m).all(), "all joints must be finite"
    speed_mps = np.linalg.norm(np.diff(pose.joints_m, axis=0), axis=2).max() / float(np.diff(pose.time_s).max())
    assert speed_mps < 15, f"a joint moves at {speed_mps:.0f} m/s; no body does"


def check_encoder(make: "Callable[[], nn.Module]") -> None:
    """Checks an environment encoder: its shapes, and that gradients reach all of its weights.

    Args:
        make: Returns the encoder.

    Raises:
        AssertionError: If a check fails.
    """
    import torch

    from mmweaver.models.environment_encoder import MAP_CHANNELS, Z_ENV
    from mmweaver.models.scene_tensors import IMAGE_CHANNELS

    encoder = make()
    picture = torch.rand(2, IMAGE_CHANNELS, 96, 128)
    z_env, places = encoder(picture)
    assert z_env.shape == (2, Z_ENV), f"z_env must be (room, {Z_ENV}), not {tuple(z_env.shape)}"
    wanted = (2, MAP_CHANNELS, 12, 16)
    assert places.shape == wanted, f"the map of 96 x 128 pixels must be {wanted}, not {tuple(places.shape)}"
    (z_env.square().sum() + places.square().sum()).backward()
    without = [name for name, weight in encoder.named_parameters() if weight.requires_grad and weight.grad is None]
    assert not without, f"no gradient reaches {without[0]}"


def _check_cube(cube: RadarCube, grid: CubeGrid, config: RadarConfig) -> None:
    assert isinstance(cube, RadarCube), f"a signal's cube must be a RadarCube, not {type(cube).__name__}"
    assert cube.values.shape == grid.shape, f"the cube must be {grid.shape}, not {cube.values.shape}"
    assert cube.values.dtype == np.complex64, f"the cube must be complex64, not {cube.values.dtype}"
    assert np.isfinite(cube.values).all(), "the cube must be finite"
    assert cube.config == config, "the cube must have the radar that was asked for"
    for name in ("frame_time_s", "range_m", "radial_velocity_mps", "antenna_position_m"):
        _equal(getattr(cube.grid, name), getattr(grid, name), f"the cube's {name} must be the radar's own")


def _check_samples(adc: AdcCube, config: RadarConfig) -> None:
    wanted = (FRAMES, config.num_loops, config.num_slots, config.num_rx, config.num_samples)
    assert adc.samples.shape == wanted, f"ADC samples must be {wanted}, not {adc.samples.shape}"
    assert adc.samples.dtype == np.complex64, f"ADC samples must be complex64, not {adc.samples.dtype}"
    assert np.isfinite(adc.samples).all(), "ADC samples must be finite"


def _equal(one: np.ndarray, other: np.ndarray, sentence: str) -> None:
    assert np.array_equal(one, other), sentence


def _unless_refused(make: Callable[[], Generation]) -> Generation | None:
    try:
        return make()
    except InputError:
        return None
