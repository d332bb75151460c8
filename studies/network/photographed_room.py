"""How much of the static echoes of a room can be predicted from its photo, and which parts cannot?

    python -m studies run photographed_room
    python -m studies run photographed_room --scan     # from a scan of it, as in `whole_room`

Empty rooms of the nine kinds that training may see, in layouts of no data set. Ground truth is the simulator in the
true room, with all paths and clutter; range-azimuth pictures of one frame without noise are compared. `realization`,
the oracle, is the true room with other micro-phases of its rough surfaces and other clutter. The rows between replace
one kind of the photographed room's echoes by those of the true room, specular ones with random phases. Intervals:
bootstrap over rooms.
"""

import argparse
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from scipy.spatial import KDTree

from mmweaver.core.presets import PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RgbdPhoto, Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_plan import HeldOut
from mmweaver.dsp.cube import radar_cube
from mmweaver.dsp.spectra import azimuth_axis_rad, range_azimuth_power
from mmweaver.metrics.map_scores import log_map_difference_db
from mmweaver.paths.adc_synthesis import AdcSynthesis
from mmweaver.paths.diffuse_clutter import seed_of_room
from mmweaver.paths.paths import STATIC_KINDS, Interaction
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.static_paths import ALL_PATHS, RayTracedRoom
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.procedural.room_kinds import KINDS
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.network.learned_scores import interval
from studies.network.whole_room import scanned
from studies.result_rows import complete_rows
from studies.scores.map_similarity import log_map_ssim

REALIZATION = "realization"  # the true room with other micro-phases
UNKNOWN = {
    "dataset.sha256": "rendered anew in every run",
    "seconds": "see the manifest: all rows together",
}
KINDS_OF_PATHS = (*STATIC_KINDS, Interaction.ROOM_ROOM, Interaction.CLUTTER)
LAYOUTS = (30, 31, 32, 33)
METRICS = {
    "ra_ssim": ("1", "SSIM of 50 dB range-azimuth pictures over cells that either shows"),
    "ra_difference_db": ("dB", "absolute difference of the same pictures per cell that the truth shows"),
}
Scores = dict[str, dict[str, float]]


def evaluated(kind: str, layout: int, seed: int = 0, *, by: str = "photo") -> Scores:
    """Scores of one room by method; `by` a "photo" or a "scan" of it."""
    config = PRESETS["awr1843"]
    made = make_room(kind, layout, seed)
    truth, realization = (_room(made.scene("day"), config, seed) for seed in (0, 1))
    if by == "scan":
        scene = scanned(made)
        variants = {"scan, true materials": _with_materials_of(scene, made.scene("day"))}
    else:
        photo = made.photo("day", noise=True)
        scene, variants = reconstruct(photo), {"photo without mask": reconstruct(_without_mask(photo))}
    own, true = _parts(_room(scene, config, 1)), _parts(realization)
    specular = _parts(realization, turned=stream(layout, kind, "mirrors"))[Interaction.SPECULAR]
    cubes = {
        "zeros": 0 * _adc(truth),
        **{name: _adc(_room(variant, config, 1)) for name, variant in variants.items()},
        by: sum(own.values()),
        f"{by}, true specular reflectors": sum((own | {Interaction.SPECULAR: specular}).values()),
        f"{by}, true edges": sum((own | {Interaction.EDGE: true[Interaction.EDGE]}).values()),
        f"{by}, true surfaces": sum((own | {Interaction.DIFFUSE: true[Interaction.DIFFUSE]}).values()),
        f"{by}, true second order": sum((own | {Interaction.ROOM_ROOM: true[Interaction.ROOM_ROOM]}).values()),
        REALIZATION: _adc(realization),
    }
    azimuth = azimuth_axis_rad()

    def picture(adc: Any) -> np.ndarray:
        samples = np.repeat(np.asarray(adc)[None, None], config.num_loops, axis=1).astype(np.complex64)
        return range_azimuth_power(radar_cube(AdcCube(samples=samples, config=config, scale=1.0)), azimuth)

    shown = picture(_adc(truth))
    return {
        name: {
            "ra_ssim": log_map_ssim(picture(adc), shown), "ra_difference_db": log_map_difference_db(picture(adc), shown)
        }
        for name, adc in cubes.items()
    }  # fmt: skip


def _room(scene: Scene, config: RadarConfig, seed: int) -> RayTracedRoom:
    """All static paths of a scene, with clutter of its own."""
    return Simulator(scene, config, micro_seed=seed_of_room(scene) + seed, propagation=ALL_PATHS).room


def _without_mask(photo: RgbdPhoto) -> RgbdPhoto:
    return RgbdPhoto(rgb=photo.rgb, depth_m=photo.depth_m, intrinsics=photo.intrinsics)


def _with_materials_of(scene: Scene, true: Scene) -> Scene:
    """The scene with the material of the nearest of the true faces on each of its own."""
    nearest = KDTree(true.vertices_m[true.faces].mean(axis=1)).query(scene.vertices_m[scene.faces].mean(axis=1))[1]
    names = (*scene.material_names, *(name for name in true.material_names if name not in scene.material_names))
    materials = np.array([names.index(name) for name in true.material_names])[true.face_material[nearest]]
    return replace(scene, face_material=materials.astype(np.int32), material_names=names)


def _adc(room: RayTracedRoom) -> np.ndarray:
    """Samples (tx, rx, sample) of a room."""
    return AdcSynthesis(room.config).static(room.paths).numpy()


def _parts(room: RayTracedRoom, turned: np.random.Generator | None = None) -> dict[Interaction, np.ndarray]:
    """Samples of the static paths of a room by kind, with other phases where `turned` samples them."""
    found = {}
    for kind in KINDS_OF_PATHS:
        part = room.paths.select(kind)
        if turned is not None:
            cycles = turned.random(len(part))
            part = replace(part, amplitude=part.amplitude.abs() * torch.from_numpy(np.exp(2j * np.pi * cycles)))
        found[kind] = AdcSynthesis(room.config).static(part).numpy()
    return found


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--layouts", type=int, nargs="+", default=list(LAYOUTS))
    parser.add_argument("--scan", action="store_true", help="rooms from a scan, in place of a photo")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rooms = [(kind, layout) for kind in KINDS if kind not in HeldOut().test_kinds for layout in options.layouts]
    by = "scan" if options.scan else "photo"
    scores = [evaluated(kind, layout, by=by) for kind, layout in rooms]
    names = [f"{kind}_{layout}" for kind, layout in rooms]
    rows = [_row(method, scores, names) for method in scores[0]]
    settings = {"layouts": options.layouts, "kinds": sorted({kind for kind, _ in rooms}), "radar": "awr1843"}
    dataset = {"name": "procedural rooms, nobody in them", "split": "layouts of no data set"}
    rows = complete_rows(
        rows, dataset=dataset, seeds=[0], baselines=("zeros",), oracles=(REALIZATION,), unknown=UNKNOWN
    )
    run.write("photographed_room", "scan" if options.scan else "echoes", config=settings, rows=rows)


def _row(method: str, scores: list[Scores], rooms: list[str]) -> dict[str, Any]:
    metrics = {}
    for name, (unit, definition) in METRICS.items():
        mean, low, high = interval(np.array([score[method][name] for score in scores]), rooms)
        metrics[name] = {
            "value": mean, "interval_95": [low, high], "unit": unit,
            "definition": definition, "version": 1,
        }  # fmt: skip
    return {"method": method, "n": len(scores), "num_rooms": len(scores), "metrics": metrics}
