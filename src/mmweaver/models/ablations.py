"""What is put in the place of parts of the network that are left out, to see what they are worth."""

from dataclasses import replace

import torch
from torch import Tensor

from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.body_anchors import ANCHORS, Anchors
from mmweaver.models.body_prior import BodyPrior
from mmweaver.models.scene_tensors import SceneTensors

STRENGTH = 7  # column of SceneTensors.point_features: what physics says of a point's strength
FLAT_M2, FLAT_OFFSET_M = 0.02, -0.06


def uniform_surfaces(view: SceneTensors) -> SceneTensors:
    """A room whose static echoes all have their mean strength: where they are is known, how strong is not."""
    known = view.point_cross_section_m2
    there = known > 0
    mean = known.sum(-1, keepdim=True) / there.sum(-1, keepdim=True).clamp(min=1)
    features = view.point_features.clone()
    features[..., STRENGTH] = 0.0
    return replace(view, point_cross_section_m2=mean * there, point_features=features)


def flat_body(prior: BodyPrior) -> BodyPrior:
    """A body all of whose parts return alike, with skin a little before each."""
    section = prior.cross_section_m2
    return BodyPrior(
        cross_section_m2=torch.full_like(section, FLAT_M2), offset_m=torch.full_like(section, FLAT_OFFSET_M)
    )


def joints_alone(body: Anchors, prior: BodyPrior) -> tuple[Anchors, BodyPrior]:
    """No echoes between joints: what skin returns there is given to the nearer joint."""
    to = torch.tensor([first if part < 0.5 else second for first, second, part in ANCHORS])
    given = torch.zeros(len(ANCHORS), len(ANCHORS))
    given[torch.arange(len(ANCHORS)), to] = 1.0
    is_joint = torch.arange(len(ANCHORS), device=body.share.device) < NUM_JOINTS
    section = prior.cross_section_m2 @ given.to(prior.cross_section_m2)
    return replace(body, share=body.share * is_joint), replace(prior, cross_section_m2=section)


def level_alone(said: Tensor) -> Tensor:
    """The network's output for moving echoes, with strengths but without steps in position and velocity."""
    return said * (torch.arange(said.shape[-1], device=said.device) == 0)
