"""Physical prior of a body's echoes for the network: strength of each part, and the position of its skin.

Computed from the simulator's skin on a person of average height, without rays: everything that faces the radar counts,
nothing is occluded. The network scales it, as it does with the physical prior of the room's surfaces.
Reference: docs/decisions/skin.md, docs/decisions/network-predicts-echoes.md.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.tensor_record import TensorRecord
from mmweaver.models.body_anchors import MIRRORED, NUM_ANCHORS, NUM_REFLECTORS, anchor_places
from mmweaver.propagation.body_model import average_body


@dataclass(frozen=True, kw_only=True)
class BodyPrior(TensorRecord):
    """Cross section in m2 of each anchor (..., frame, anchor), and range offset of its skin in m."""

    cross_section_m2: Tensor
    offset_m: Tensor  # negative in front of the anchor, where skin is


def body_prior(joints_m: Tensor) -> BodyPrior:
    """The prior of motions.

    Args:
        joints_m: Joints (sequence, frame, 22, 3) in metres, in the radar's coordinates.

    Returns:
        Cross sections and offsets (sequence, frame, anchor), on the device of the joints.
    """
    if joints_m.is_meta:  # shapes alone, no numbers
        nothing = joints_m.new_zeros((*joints_m.shape[:2], NUM_ANCHORS))
        return BodyPrior(cross_section_m2=nothing, offset_m=nothing)
    with torch.no_grad():
        anchors = anchor_places(joints_m.detach().cpu()).double().numpy()
        parts = [_one(joints, place) for joints, place in zip(joints_m.detach().cpu().numpy(), anchors, strict=True)]
    stacked = [np.stack(each).astype(np.float32) for each in zip(*parts, strict=True)]
    section, offset = (torch.from_numpy(each).to(joints_m) for each in stacked)
    return BodyPrior(cross_section_m2=section, offset_m=offset)


BOTH_WAYS = 1.0  # two directions of travel, half of which is blocked by furniture


def ghost_section(joints_m: Tensor, prior: BodyPrior) -> Tensor:
    """Cross section of the body's images, before the reflection by the face.

    Each of the few anchors that represent the body in reflections has the sum of all anchors nearest to it.

    Args:
        joints_m: Joints (..., frame, 22, 3) in metres.
        prior: Prior of the same motions.

    Returns:
        Cross section (..., frame, ghost) in m2.
    """
    places = anchor_places(joints_m)
    nearest = torch.cdist(places, places[..., MIRRORED, :]).argmin(dim=-1)
    of = torch.nn.functional.one_hot(nearest, len(MIRRORED)).to(prior.cross_section_m2)
    section = BOTH_WAYS * (prior.cross_section_m2[..., None, :] @ of)[..., 0, :]
    return section.repeat(*[1] * (section.dim() - 1), NUM_REFLECTORS)


def _one(joints_m: np.ndarray, anchors_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    body = average_body()
    skin = body.skin(joints_m.astype(float))
    distance = np.linalg.norm(skin.place_m, axis=-1)
    cos = -(skin.normal * skin.place_m).sum(-1) / np.maximum(distance, 1e-6)
    section = body.echo.monostatic(cos) * body.area_m2 * body.brightness  # (frame, point)
    gap = np.linalg.norm(skin.place_m[0][:, None] - anchors_m[0][None], axis=-1)
    of = np.zeros((len(body.part), NUM_ANCHORS))
    of[np.arange(len(of)), gap.argmin(axis=1)] = 1.0
    total = section @ of
    behind = (section * distance) @ of / np.maximum(total, 1e-12) - np.linalg.norm(anchors_m, axis=-1)
    return total, np.where(total > 1e-9, np.clip(behind, -0.3, 0.3), 0.0)
