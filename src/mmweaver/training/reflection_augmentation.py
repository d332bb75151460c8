"""Left and right exchanged: every room and motion twice. A radar's mean power maps have no handedness."""

from dataclasses import replace

import torch
from torch import Tensor

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.paths.mean_power import PowerMaps
from mmweaver.training.network_loss import Targets

_OTHER_SIDE = {"left": "right", "right": "left"}
_POINT_X = (1, 5)  # of a point's features: its place and its direction
_PLANE_X = (6,)  # of a plane's: its normal


def reflected_scene(view: SceneTensors) -> SceneTensors:
    """The room as in a mirror that stands along the radar's axis."""
    flip = view.point_m.new_tensor([-1.0, 1.0, 1.0])
    camera = view.camera.clone()
    camera[..., 2] = view.image.shape[-1] - 1 - camera[..., 2]
    return replace(
        view,
        image=view.image.flip(-1),
        depth_m=view.depth_m.flip(-1),
        point_m=view.point_m * flip,
        point_features=_negated(view.point_features, _POINT_X),
        camera_from_radar=view.camera_from_radar * flip * flip[:, None],
        camera=camera,
        plane_centre_m=view.plane_centre_m * flip,
        plane_axes=view.plane_axes * flip,
        plane_features=_negated(view.plane_features, _PLANE_X),
    )


def reflected_joints(joints: Tensor) -> Tensor:
    """Places or velocities (..., 22, 3) of the mirrored person: what was left is right."""
    order = [JOINT_NAMES.index(_other(name)) for name in JOINT_NAMES]
    return joints[..., order, :] * joints.new_tensor([-1.0, 1.0, 1.0])


def reflected_targets(targets: Targets) -> Targets:
    """Azimuth runs the other way; range, Doppler and elevation stay."""
    person = None if targets.person is None else _azimuth_flipped(targets.person)
    return Targets(maps=_azimuth_flipped(targets.maps), empty=_azimuth_flipped(targets.empty), person=person)


def _azimuth_flipped(maps: PowerMaps) -> PowerMaps:
    return replace(maps, range_azimuth=maps.range_azimuth.flip(-1))


def _negated(features: Tensor, columns: tuple[int, ...]) -> Tensor:
    sign = torch.ones(features.shape[-1], device=features.device)
    sign[list(columns)] = -1
    return features * sign


def _other(name: str) -> str:
    side, _, part = name.partition("_")
    return f"{_OTHER_SIDE[side]}_{part}" if side in _OTHER_SIDE else name
