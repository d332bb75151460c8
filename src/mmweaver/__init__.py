"""mmWeaver: a photo of a room and a sentence in, the I/Q signal of an FMCW MIMO radar out.

Start with `Weaver`. Names are imported when first used, so `import mmweaver` is cheap. `mmweaver.weaver.register` adds
methods, radars, detectors, activities and encoders; `mmweaver.weaver.testing` checks them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mmweaver.core.constants import __version__

if TYPE_CHECKING:
    from mmweaver.core.board import Board
    from mmweaver.core.boards import PRESETS
    from mmweaver.core.errors import InputError
    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.core.radar_pose import RadarPose
    from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube, Scene
    from mmweaver.evaluation.calibrate import Calibration, calibrate
    from mmweaver.evaluation.compare_signals import Comparison, compare
    from mmweaver.io.npz_files import read_radar_npz
    from mmweaver.io.radar_file import load_radar
    from mmweaver.recordings.processing import process_recording
    from mmweaver.recordings.read_recording import Recording, read_recording
    from mmweaver.weaver.front_door import Weaver
    from mmweaver.weaver.generation import Generation

_HOME = {
    "AdcCube": "core.records",
    "Board": "core.board",
    "Calibration": "evaluation.calibrate",
    "Comparison": "evaluation.compare_signals",
    "Generation": "weaver.generation",
    "InputError": "core.errors",
    "PRESETS": "core.boards",
    "PointCloud": "core.records",
    "PoseSequence": "core.records",
    "RadarConfig": "core.radar_config",
    "RadarCube": "core.records",
    "RadarPose": "core.radar_pose",
    "Recording": "recordings.read_recording",
    "Scene": "core.records",
    "Weaver": "weaver.front_door",
    "calibrate": "evaluation.calibrate",
    "compare": "evaluation.compare_signals",
    "load_radar": "io.radar_file",
    "process_recording": "recordings.processing",
    "read_radar_npz": "io.npz_files",
    "read_recording": "recordings.read_recording",
}

_MODULES = {
    "features": "signal.features",
    "methods": "models.methods",
    "register": "weaver.register",
    "testing": "weaver.testing",
}

__all__ = [
    "PRESETS",
    "AdcCube",
    "Board",
    "Calibration",
    "Comparison",
    "Generation",
    "InputError",
    "PointCloud",
    "PoseSequence",
    "RadarConfig",
    "RadarCube",
    "RadarPose",
    "Recording",
    "Scene",
    "Weaver",
    "__version__",
    "calibrate",
    "compare",
    "load_radar",
    "process_recording",
    "read_radar_npz",
    "read_recording",
]


def __getattr__(name: str) -> Any:
    """Imports a public name from the module that defines it, at its first use."""
    if name in _MODULES:
        return import_module(f"mmweaver.{_MODULES[name]}")
    if name not in _HOME:
        raise AttributeError(f"module 'mmweaver' has no attribute {name!r}")
    return getattr(import_module(f"mmweaver.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, *_MODULES]
