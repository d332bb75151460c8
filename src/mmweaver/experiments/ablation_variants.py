"""What the ablation leaves out of the network, of its loss, of its training and of what it is shown."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Variant:
    """Parts of the network that are left out, words in the names of terms that are, changes of the recipe, whether
    targets are single drawn signals, and whose photo is shown when it is judged."""

    without: tuple[str, ...] = ("correction",)
    terms_without: tuple[str, ...] = ()
    recipe: tuple[tuple[str, Any], ...] = ()
    is_drawn: bool = False
    photo: str = "own"  # or "generic", "shuffled"

    @property
    def is_trained_as_whole(self) -> bool:
        """Whether it is the whole network, looked at otherwise."""
        return self == Variant(photo=self.photo)


WHOLE = "whole"
VARIANTS = {
    WHOLE: Variant(),
    "before training": Variant(recipe=(("steps", 0),)),
    # of the whole, when it is judged
    "generic photo": Variant(photo="generic"),
    "shuffled photo": Variant(photo="shuffled"),
    # anchors and what physics says
    "no ghosts": Variant(without=("ghosts", "correction")),
    "no echoes between joints": Variant(without=("between joints", "correction")),
    "no physics of the body": Variant(without=("body prior", "correction")),
    "no physics of surfaces": Variant(without=("room prior",)),
    "no physics at all": Variant(without=("room prior", "body prior")),
    # heads
    "no steps of echoes": Variant(without=("steps", "correction")),
    "surfaces turned up and down": Variant(without=()),
    "no learned faces": Variant(without=("faces", "correction")),
    # the encoder's picture; where surfaces stand is known in all
    "colour alone": Variant(without=("depth", "mask", "correction")),
    "depth alone": Variant(without=("colour", "mask", "correction")),
    "mask alone": Variant(without=("colour", "depth", "correction")),
    "no picture": Variant(without=("colour", "depth", "mask", "correction")),
    # losses and targets
    "no target of the person alone": Variant(terms_without=("_person",)),
    "no target of the empty room": Variant(terms_without=("_empty",)),
    "no pooled maps": Variant(terms_without=("_4x2", "_8x8")),
    "single draws, no expected maps": Variant(is_drawn=True),
    "no mirrored rooms": Variant(recipe=(("mirror", False),)),
}
