"""The network with parts left out, to see what they are worth, and what is put in their place."""

from collections.abc import Iterable
from dataclasses import replace

import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.body_anchors import ANCHORS, Anchors
from mmweaver.models.scatterer_network import MAX_STEP, BodyPrior, SceneEncoding, WeaverNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.propagation.mean_power import MeanEchoes

STRENGTH = 7  # column of SceneTensors.point_features: what physics says of a point's strength
FLAT_M2, FLAT_OFFSET_M = 0.02, -0.06
PARTS = (
    "faces", "ghosts", "correction", "colour", "depth", "mask", "room prior", "body prior", "between joints", "steps",
)  # fmt: skip
CHANNELS = {"colour": [0, 1, 2], "depth": [3], "mask": [4]}


class AblatedNetwork(WeaverNetwork):
    """The network without some of its `PARTS`. Raises InputError for unknown ones."""

    def __init__(self, without: Iterable[str] = ()) -> None:
        self.without = frozenset(without)
        if unknown := self.without - set(PARTS):
            raise InputError(f"unknown parts {', '.join(sorted(unknown))}; known: {', '.join(PARTS)}")
        super().__init__(corrects_surfaces="correction" not in self.without)
        if "room prior" in self.without:
            self.max_correction = MAX_STEP

    def encode_room(self, view: SceneTensors) -> SceneEncoding:
        view = uniform_surfaces(view) if "room prior" in self.without else view
        return super().encode_room(replace(view, image=self._shown(view.image)))

    def anchors(self, joints_m: Tensor, velocity_mps: Tensor, view: SceneTensors) -> tuple[Anchors, Anchors, BodyPrior]:
        body, ghosts, prior = super().anchors(joints_m, velocity_mps, view)
        prior = flat_body(prior) if "body prior" in self.without else prior
        if "between joints" in self.without:
            body, prior = joints_alone(body, prior)
        if "ghosts" in self.without:
            ghosts = replace(ghosts, share=0 * ghosts.share)
        return body, ghosts, prior

    def steps(self, mixed: Tensor) -> Tensor:
        steps = super().steps(mixed)
        return level_alone(steps) if "steps" in self.without else steps

    def _shown(self, image: Tensor) -> Tensor:
        if self.without >= set(CHANNELS):  # the gradients of group norms are unbounded for an even black picture
            return torch.full_like(image, 0.5)
        kept = torch.ones(image.shape[1], device=image.device)
        for name in self.without & set(CHANNELS):
            kept[CHANNELS[name]] = 0.0
        return image * kept[:, None, None]

    def _faces(self, view: SceneTensors) -> MeanEchoes:
        faces = super()._faces(view)
        return replace(faces, cross_section_m2=0 * faces.cross_section_m2) if "faces" in self.without else faces


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


def level_alone(steps: Tensor) -> Tensor:
    """The network's output for moving echoes, with strengths but without steps in position and velocity."""
    return steps * (torch.arange(steps.shape[-1], device=steps.device) == 0)
