"""Variants of the ablation: what is removed from the network, its loss, its training and its input."""

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class AblationVariant:
    """One variant.

    Attributes:
        without: parts of the network that are removed.
        terms_without: words in the names of loss terms that are removed.
        recipe: changes of the training recipe.
        is_sampled: whether targets are maps of single sampled signals rather than expected maps.
        photo: whose photo is the input when it is evaluated: "own", "generic" or "shuffled".
        motion: whose joints are the input when it is evaluated: "own", or "other", the room's next sequence.
        power: in place of the network recipe `paper_power`, a hypernetwork that writes fields of power, with
            coordinates counted from what is seen.
        has_one_code: whether its fields are written with the code of the generic photo and one pose, whatever is seen.
    """

    without: tuple[str, ...] = ("correction",)
    terms_without: tuple[str, ...] = ()
    recipe: tuple[tuple[str, Any], ...] = ()
    is_sampled: bool = False
    photo: str = "own"  # or "generic", "shuffled"
    motion: str = "own"  # or "other"
    power: bool = False
    has_one_code: bool = False

    @property
    def trained_as(self) -> "AblationVariant":
        """The variant whose training it shares: the same, evaluated with its own photo, motion and code."""
        return replace(self, photo="own", motion="own", has_one_code=False)


WHOLE, HYPERNETWORK = "whole", "hypernetwork and INR"
POWER = (("frames", 3), ("learning_rate", 1.5e-3))  # as the weights of `paper_power` were trained
VARIANTS = {
    WHOLE: AblationVariant(),
    "before training": AblationVariant(recipe=(("steps", 0),)),
    # of the whole, when it is evaluated
    "generic photo": AblationVariant(photo="generic"),
    "shuffled photo": AblationVariant(photo="shuffled"),
    "another motion": AblationVariant(motion="other"),
    # what the paper has in place of echoes on joints and surfaces
    HYPERNETWORK: AblationVariant(power=True, recipe=POWER),
    f"{HYPERNETWORK}, generic photo": AblationVariant(power=True, recipe=POWER, photo="generic"),
    f"{HYPERNETWORK}, another motion": AblationVariant(power=True, recipe=POWER, motion="other"),
    f"{HYPERNETWORK}, one code for all": AblationVariant(power=True, recipe=POWER, has_one_code=True),
    # anchors and what physics says
    "no ghosts": AblationVariant(without=("ghosts", "correction")),
    "no echoes between joints": AblationVariant(without=("between joints", "correction")),
    "no physics of the body": AblationVariant(without=("body prior", "correction")),
    "no physics of surfaces": AblationVariant(without=("room prior",)),
    "no physics at all": AblationVariant(without=("room prior", "body prior")),
    # heads
    "no steps of echoes": AblationVariant(without=("steps", "correction")),
    "no learned reflectors": AblationVariant(without=("faces", "correction")),
    # the encoder's picture; where surfaces stand is known in all
    "no picture": AblationVariant(without=("colour", "depth", "mask", "correction")),
    # losses and targets
    "no target of the person alone": AblationVariant(terms_without=("_person",)),
    "no target of the background": AblationVariant(terms_without=("_empty",)),
    "sampled signals, no expected maps": AblationVariant(is_sampled=True),
    "no reflected rooms": AblationVariant(recipe=(("mirror", False),)),
}
