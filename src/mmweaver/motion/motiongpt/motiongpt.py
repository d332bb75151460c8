"""From a MotionGPT checkpoint and a sentence to a MotionClip. Start with this file.

text --words--> ids --T5--> motion codes --decoder--> features --mean, std--> joints

Constant bone lengths: the decoder predicts joints independently, so that bones stretch by per cents between frames.

A radar would observe the stretching as motion.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.repository_files import repository_file
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.core.skeleton import PARENTS
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.joint_arrays import CONTACTS, FPS, NUM_FEATURES, joints_from_features
from mmweaver.motion.motiongpt.checkpoint import (
    LANGUAGE,
    MEAN,
    SMALL,
    STD,
    VAE,
    VOCABULARY,
    check_state,
    looks_like_hub,
    parts_of,
    published_checkpoint,
    read_checkpoint,
    t5_sizes,
    tokenizer_config,
)
from mmweaver.motion.motiongpt.language_model import (
    LONGEST_TEXT_TOKENS,
    WORD_FILES,
    add_motion_tokens,
    build_t5,
    load_words,
    sample_codes,
    unknown_words,
    wrapped,
)
from mmweaver.motion.motiongpt.tokenizer import MotionTokenizer

if TYPE_CHECKING:
    from transformers import PreTrainedTokenizerBase, T5ForConditionalGeneration


def fix_bone_lengths(joints: Float[np.ndarray, "frame 22 3"]) -> Float[np.ndarray, "frame 22 3"]:
    """Rescales each bone to its median length, with unchanged directions.

    The pelvis keeps its position on the floor, the lower foot its height.

    Args:
        joints: Joints in metres, z up, (frame, 22, 3).

    Returns:
        Joints (frame, 22, 3) with constant bone lengths.
    """
    steady = joints.copy()
    for child, parent in enumerate(PARENTS):
        if parent >= 0:
            bone = joints[:, child] - joints[:, parent]
            length = np.linalg.norm(bone, axis=-1, keepdims=True)
            steady[:, child] = steady[:, parent] + bone * (np.median(length) / np.maximum(length, 1e-9))
    sunk = steady[..., 2].min(axis=1) - joints[..., 2].min(axis=1)
    steady[..., 2] -= sunk[:, None]
    return steady


Array = np.ndarray
SMALL_NAME = "small"
ENDINGS = (".safetensors", ".tar", ".ckpt", ".pt", ".pth", ".bin")
MIN_FRAMES, MAX_FRAMES = 40, 196  # range of MotionGPT's training data
RAW_CONTACT_STD = (0.2, 0.6)  # of HumanML3D's own Std.npy; MotionGPT's differs by a factor of about 25


@dataclass(frozen=True, kw_only=True)
class MotionGPT:
    """A MotionGPT model for inference.

    Attributes:
        tokenizer: Motion tokenizer.
        language: Language model.
        words: Its text tokenizer, with the motion tokens.
        mean: Mean of the HumanML3D features, (263,).
        std: Standard deviation of the features, (263,).
        first_motion_id: Id of the first motion token.
        name: Name in notes and error messages.
    """

    tokenizer: MotionTokenizer
    language: "T5ForConditionalGeneration"
    words: "PreTrainedTokenizerBase"
    mean: Float[Array, " feature"]
    std: Float[Array, " feature"]
    first_motion_id: int
    name: str

    @classmethod
    def load(
        cls,
        path: str | Path,
        *,
        mean: str | Path | None = None,
        std: str | Path | None = None,
        words: str | Path | None = None,
    ) -> "MotionGPT":
        """Loads a checkpoint.

        The published checkpoint needs MotionGPT's own `mean.npy` and `std.npy` (its assets/meta), not HumanML3D's, and
        the text tokenizer of flan-t5-base. A file of this project (.safetensors) holds everything.

        Args:
            path: Checkpoint file, folder that holds one, name on the Hub (owner/name), or "small" for the one in a
                clone.
            mean: Mean of the features, .npy; None looks next to the checkpoint.
            std: Standard deviation of the features, .npy; None looks next to the checkpoint.
            words: Folder of the text tokenizer; None looks next to the checkpoint, then on the Hub.

        Raises:
            InputError: If it is not such a model.
        """
        need("pretrained", "the motion model", "transformers")
        place = _place_of(path)
        state, notes = read_checkpoint(place)
        vae, spoken = parts_of(state, place)
        tokenizer = MotionTokenizer(tokenizer_config(vae, place))
        check_state(vae, tokenizer.state_dict(), VAE, place)
        language = _language(spoken, place)
        own = {name: state[name].float().numpy() for name in (MEAN, STD) if name in state}
        mean_values = own[MEAN] if MEAN in own else _statistic(mean, place, "mean", tokenizer.config.features)
        std_values = own[STD] if STD in own else _statistic(std, place, "std", tokenizer.config.features)
        if STD not in own:
            check_std(std_values, place)
        vocabulary = notes.get(VOCABULARY)
        plain = wrapped(vocabulary) if vocabulary else load_words(_words_folder(place, words))
        first = add_motion_tokens(plain, tokenizer.config.codes)
        if first + tokenizer.config.codes + 3 > language.config.vocab_size:
            raise InputError(
                f"{place} knows {language.config.vocab_size} tokens, its words and {tokenizer.config.codes + 3} motion"
                f" tokens are {first + tokenizer.config.codes + 3}; the words are of another model"
            )
        tokenizer.load_state_dict(
            {name: value.float() for name, value in vae.items() if name in tokenizer.state_dict()}
        )
        return cls(
            tokenizer=tokenizer.eval(),
            language=language,
            words=plain,
            mean=mean_values.astype(float),
            std=std_values.astype(float),
            first_motion_id=first,
            name=place.name,
        )

    def generate(
        self, text: str, *, seconds: float | None = None, seed: int = 0, temperature: float = 1.0, top_k: int = 50
    ) -> MotionClip:
        """Generates the motion of a sentence at 20 frames per second.

        Args:
            text: The sentence.
            seconds: Exact duration, up to 9.8 s as trained; None lets the model choose.
            seed: Seed; the same seed gives the same motion.
            temperature: Sampling temperature.
            top_k: Number of most likely tokens to sample from.

        Returns:
            22 joints in metres, z up.

        Raises:
            InputError: If the text is empty or too long, or the model was not trained on the duration.
        """
        if not text.strip():
            raise InputError("the text is empty; say what the person does")
        per_token = self.tokenizer.config.frames_per_token
        frames = None if seconds is None else int(np.ceil(seconds * FPS - 1e-9))
        if frames is not None and not 1 <= frames <= MAX_FRAMES:
            raise InputError(
                f"the motion model makes up to {MAX_FRAMES / FPS:g} s at a time, {seconds:g} s are needed; use"
                " fewer --frames"
            )
        tokens = None if frames is None else -(-max(frames, MIN_FRAMES) // per_token)
        codes = sample_codes(
            self.language,
            torch.tensor([self._ids(text)]),
            first_motion_id=self.first_motion_id,
            codes=self.tokenizer.config.codes,
            tokens=tokens,
            most_tokens=MAX_FRAMES // per_token,
            seed=seed,
            temperature=temperature,
            top_k=top_k,
        )
        if not codes:
            raise InputError(
                f"the motion model {self.name} generates no motion for {text!r}; try another text or --seed"
            )
        joints = joints_from_features(self.features_of(codes)[:frames])
        notes = [f"the motion was made by {self.name} and is one random sample (seed {seed})"]
        odd = unknown_words(self.words, text)
        if odd:
            notes.append(f"the motion model does not know these words: {', '.join(odd)}")
        z_up = np.stack([joints[..., 0], -joints[..., 2], joints[..., 1]], axis=-1)
        return MotionClip(joints_m=fix_bone_lengths(z_up), fps=FPS, label=f"{self.name}: {text}", notes=tuple(notes))

    def features_of(self, codes: list[int]) -> Float[Array, "frame 263"]:
        """Decodes motion codes, four frames each.

        Args:
            codes: Motion codes.

        Returns:
            HumanML3D features (frame, 263).
        """
        with torch.inference_mode():
            made = self.tokenizer.decode(torch.tensor([codes]))[0].double().numpy()
        return made * self.std + self.mean

    def codes_of(self, features: Float[Array, "frame 263"]) -> list[int]:
        """Encodes features as motion codes.

        Args:
            features: HumanML3D features (frame, 263), not normalised.

        Returns:
            Motion codes, one per four frames.
        """
        normal = torch.from_numpy(((features - self.mean) / self.std)[None]).float()
        with torch.inference_mode():
            return self.tokenizer.encode(normal)[0].tolist()

    def _ids(self, text: str) -> list[int]:
        ids: Any = self.words(text.strip()).input_ids
        if len(ids) > LONGEST_TEXT_TOKENS:
            raise InputError(
                f"the text has {len(ids)} tokens, the motion model takes {LONGEST_TEXT_TOKENS}; use a shorter text"
            )
        return list(ids)


def check_std(std: Float[Array, " feature"], place: Path) -> None:
    """Rejects HumanML3D's own Std.npy, with which MotionGPT's tokenizer gives broken motion.

    Args:
        std: Standard deviation of the features, (263,).
        place: Checkpoint, for the error message.

    Raises:
        InputError: If the foot contacts have HumanML3D's standard deviation.
    """
    low, high = RAW_CONTACT_STD
    if low < float(np.mean(std[CONTACTS])) < high:
        raise InputError(
            f"the std next to {place.name} is HumanML3D's own (foot contacts vary by {np.mean(std[CONTACTS]):.2f});"
            " MotionGPT needs the std.npy of its own assets/meta, which differs by a factor of about 25 in channels 0:4"
            " and 259:263"
        )


def small_file() -> Path:
    """Path of the small model in a clone of the repository.

    Raises:
        InputError: If mmweaver was installed without it.
    """
    otherwise = (
        f"give the path of {SMALL} from the folder weights/ of a clone, or a name on the Hub (owner/name) that holds it"
    )
    return repository_file(SMALL, "the small motion model", otherwise)


def _place_of(path: str | Path) -> Path:
    if str(path) == SMALL_NAME:
        return small_file()
    return published_checkpoint(str(path)) if looks_like_hub(str(path)) else _checkpoint_in(Path(path))


def _checkpoint_in(path: Path) -> Path:
    if not path.is_dir():
        return path
    found = sorted(file for file in path.iterdir() if file.suffix in ENDINGS)
    if len(found) != 1:
        what = "no checkpoint" if not found else f"{len(found)} checkpoints ({', '.join(f.name for f in found[:3])})"
        raise InputError(f"{path} holds {what}; give the file of one ({', '.join(ENDINGS)})")
    return found[0]


def _language(spoken: dict[str, torch.Tensor], place: Path) -> "T5ForConditionalGeneration":
    sizes = t5_sizes(spoken, place)
    language = build_t5(sizes)
    full = dict(spoken)
    for name in ("encoder.embed_tokens.weight", "decoder.embed_tokens.weight"):
        full.setdefault(name, spoken["shared.weight"])
    if sizes["tie_word_embeddings"]:
        full.setdefault("lm_head.weight", spoken["shared.weight"])
    check_state(full, language.state_dict(), LANGUAGE, place)
    wanted = set(language.state_dict())
    language.load_state_dict({name: value.float() for name, value in full.items() if name in wanted})
    return language.eval()


def _statistic(given: str | Path | None, place: Path, name: str, features: int) -> Array:
    """mean.npy or std.npy, as given or next to the checkpoint; (feature,)."""
    path = Path(given) if given is not None else place.with_name(f"{name}.npy")
    if not path.exists():
        raise InputError(
            f"{path} is missing: the checkpoint needs MotionGPT's own {name}.npy (assets/meta of its repository) next"
            " to it"
        )
    values = ArrayChecks(path).numbers(name, read_npy(path))
    if values.shape != (features,) or features != NUM_FEATURES:
        raise InputError(f"{path} has shape {values.shape}, ({features},) features are needed")
    return values


def _words_folder(place: Path, given: str | Path | None) -> Path | None:
    if given is not None:
        return Path(given)
    is_local = any((place.parent / name).is_file() for name in WORD_FILES)
    return place.parent if is_local else None
