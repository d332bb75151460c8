"""A parser of sentences that asks a language model of the user's: an OpenAI-compatible URL, or any function.

The model returns steps by a JSON schema made of the activity records, each with the words that it stands for. Nothing
it returns is trusted: names, ranges and words are checked here, every content word has to stand for a step or be listed
as not shown, and what does not pass is asked for again, then refused. Answers are cached by text, model and schema.
"""

import hashlib
import json
import os
import re
import time
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass
from http.client import HTTPException
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from mmweaver.core.checksums import sha256_of_file
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.safe_text import parse_json, read_text
from mmweaver.motion.language.activities import BODY, HANDS
from mmweaver.motion.language.described_person import described_person
from mmweaver.motion.language.lexicon import FILLERS, NUMBERS, RADAR, SEATS, TARGETS
from mmweaver.motion.language.plan import NOT_DONE, ClauseRecord, MotionPlan, Shape, Side, Step, Way, direction_of
from mmweaver.motion.language.postures import add_shown_text, inherit_state, insert_transitions
from mmweaver.motion.language.things import face_things

TRIES, TIMEOUT_S, MAX_ANSWER_BYTES, MAX_STEPS, MAX_CHARACTERS = 3, 30.0, 65_536, 24, 1000
KEY_VARIABLE = "MMWEAVER_PARSER_KEY"  # environment variable with the key of the URL, if it needs one
SCHEMA_VERSION = 1
_DIRECTIONS = [str(one) for one in (*Side, *Way, *Shape)]
_FACINGS = ["left", "right", "towards", "away", "sideways", *sorted(set(TARGETS.values()) - {"wall"})]
_STYLES = ["back", "front", "left", "right", "high", "side", "jog"]
_NUMBERS: dict[str, tuple[float, float]] = {
    "turn_deg": (-1080, 1080),
    "distance_m": (0, 50),
    "speed_mps": (0, 6),
    "seconds": (0, 600),
    "count": (0, 60),
    "speed": (-1, 1),
}
_CHOICES: dict[str, list[str]] = {
    "lower": [one.key for one in BODY],
    "upper": ["", *(one.key for one in HANDS)],
    "hand": ["", "left", "right", "both"],
    "foot": ["", "left", "right"],
    "direction": ["", *_DIRECTIONS],
    "facing": ["", *_FACINGS],
    "target": ["", *sorted(set(TARGETS.values()))],
    "seat": ["", *sorted(SEATS)],
    "style": ["", *_STYLES],
}
_INTEGERS = ("count", "speed")
_WORD = re.compile(r"[a-z]+(?:'[a-z]+)?|\d+(?:\.\d+)?")
INSTRUCTIONS = (
    "Read a sentence on what a person does in a room before a radar. Answer with JSON alone: steps in temporal order,"
    " each with `words`, the exact words of the sentence that it stands for, and `not_shown`, the words that no step"
    " shows. lower is what body and legs do, upper what hands do meanwhile. left and right of directions are the"
    " picture's, of hands, feet and turns (turn_deg, positive to the left) the person's own. Leave out what is unsaid."
)
Reply = Callable[[list[dict[str, str]]], str]


def schema() -> dict[str, Any]:
    """The JSON schema of an answer, made of the activity records."""
    properties: dict[str, Any] = {name: {"type": "string", "enum": choices} for name, choices in _CHOICES.items()}
    for name, (low, high) in _NUMBERS.items():
        kind = "integer" if name in _INTEGERS else "number"
        properties[name] = {"type": kind, "minimum": low, "maximum": high}
    words = {"type": "array", "items": {"type": "string"}, "maxItems": 100}
    step = {"type": "object", "additionalProperties": False, "required": ["lower", "words"]}
    step["properties"] = {**properties, "words": words}
    steps = {"type": "array", "items": step, "minItems": 1, "maxItems": MAX_STEPS}
    return {
        "type": "object",
        "additionalProperties": False,
        "required": ["steps", "not_shown"],
        "properties": {"steps": steps, "not_shown": words},
    }


class InvalidAnswer(Exception):  # noqa: N818 - control flow, not an error
    """An answer that does not pass; the message is sent back to the model."""


@dataclass
class ModelParser:
    """Parses sentences by a language model; follows `sentence_parser.SentenceParser`.

    Attributes:
        reply: Returns the model's answer to a list of messages.
        name: Name of the model, recorded with every plan.
        digest: Hash or fingerprint of the model, if known.
        source: Where the model is, if its name alone does not tell: answers are cached by it.
        cache: Folder of answers; None keeps none.
        tries: Number of answers that may be asked for.
    """

    reply: Reply
    name: str
    digest: str = "unknown"
    source: str = ""
    cache: Path | None = None
    tries: int = TRIES

    def __call__(self, text: str, *, in_part: bool = False) -> MotionPlan:
        """The plan of a sentence.

        Args:
            text: The sentence.
            in_part: Whether words that are not shown are recorded as not done instead of refused.

        Raises:
            InputError: If no answer passes the checks, or the model cannot be reached.
        """
        if not text.strip() or len(text) > MAX_CHARACTERS:
            raise InputError(f"the text has {len(text.strip())} characters, 1 to {MAX_CHARACTERS} are allowed")
        answer = self._cached(text)
        if answer is None:
            answer = self._asked(text)
            self._store(text, answer)
        plan = plan_of(text, checked(answer, text))
        if not in_part and any(clause.status == NOT_DONE for clause in plan.clauses):
            lost = next(clause.clause for clause in plan.clauses if clause.status == NOT_DONE)
            raise InputError(f"{lost!r} is not shown, as the model {self.name!r} reads it; say it otherwise")
        note = f"the sentence was read by the model {self.name!r} (hash or fingerprint {self.digest})"
        return MotionPlan(
            text=text, steps=plan.steps, clauses=plan.clauses, notes=(*plan.notes, note), person=plan.person
        )

    def _asked(self, text: str) -> dict[str, Any]:
        messages = [{"role": "system", "content": INSTRUCTIONS}, {"role": "user", "content": text}]
        why = ""
        for _ in range(self.tries):
            answer = self.reply(messages)
            try:
                found = _json(answer)
                plan_of(text, checked(found, text))
                return found
            except InvalidAnswer as error:
                why = str(error)
                messages.append({"role": "assistant", "content": answer[:2000]})
                messages.append({"role": "user", "content": f"Not so: {why}"})
        raise InputError(
            f"the model {self.name!r} gave no usable answer to {text[:60]!r} in {self.tries} tries; the last: {why};"
            " word it otherwise, or leave out --parser"
        )

    def _file(self, text: str) -> Path | None:
        key = json.dumps([SCHEMA_VERSION, self.source or self.name, schema(), text], sort_keys=True)
        return None if self.cache is None else self.cache / f"{hashlib.sha256(key.encode()).hexdigest()}.json"

    def _cached(self, text: str) -> dict[str, Any] | None:
        file = self._file(text)
        try:
            found = {} if file is None else _json(read_text(file, max_bytes=2 * MAX_ANSWER_BYTES))
            answer = checked(found["answer"], text)
        except (InputError, OSError, UnicodeDecodeError, KeyError, AttributeError, InvalidAnswer):
            return None
        self.digest = str(found.get("digest", "unknown"))[:80]
        return answer

    def _store(self, text: str, answer: dict[str, Any]) -> None:
        file = self._file(text)
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            partial = file.with_suffix(f".{os.getpid()}.part")
            partial.write_text(json.dumps({"answer": answer, "digest": self.digest}), encoding="utf-8")
            partial.replace(file)


def url_parser(
    url: str, *, model: str = "default", cache: Path | None = None, timeout_s: float = TIMEOUT_S
) -> ModelParser:
    """A parser that asks an OpenAI-compatible server.

    Args:
        url: Base URL, such as http://localhost:8000/v1; `#NAME` at its end names the model.
        model: Name of the model if the URL names none.
        cache: Folder of answers.
        timeout_s: Longest time of one answer in seconds.

    Raises:
        InputError: If it is no http or https URL.
    """
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise InputError(f"--parser {url[:60]!r} is no http or https URL, nor module:attribute")
    model = parts.fragment or model
    base = parts._replace(fragment="", query="").geturl().rstrip("/")
    opener = urllib.request.build_opener(_NoRedirects)

    def reply(messages: list[dict[str, str]]) -> str:
        form = {"name": "steps", "strict": True, "schema": schema()}
        body = {"model": model, "messages": messages, "temperature": 0, "seed": 0, "max_tokens": 4096}
        body["response_format"] = {"type": "json_schema", "json_schema": form}
        headers = {"Content-Type": "application/json"}
        if key := os.environ.get(KEY_VARIABLE):
            headers["Authorization"] = f"Bearer {key}"
        request = urllib.request.Request(f"{base}/chat/completions", json.dumps(body).encode(), headers)
        try:
            with opener.open(request, timeout=timeout_s) as response:
                whole = _read(response, timeout_s)
            answer = parse_json(whole, "the answer")
            parser.digest = str(answer.get("system_fingerprint") or "unknown")[:80]
            return str(answer["choices"][0]["message"]["content"])
        except (InputError, OSError, ValueError, LookupError, TypeError, AttributeError, HTTPException) as error:
            why = str(error)[:120] or type(error).__name__
            raise InputError(f"the language model at {base} gave no answer: {why}") from None

    parser = ModelParser(reply=reply, name=model, source=f"{base}#{model}", cache=cache)
    return parser


def named_parser(name: str) -> ModelParser:
    """The parser of `--parser`: a URL, the folder of a `transformers` model, or a plug-in module:attribute.

    Args:
        name: As given; the attribute of a plug-in is a function from messages to the model's answer.

    Raises:
        InputError: If it is none of them.
    """
    if "://" in name:
        return url_parser(name, cache=cache_folder())
    if Path(name).is_dir():
        return _local_parser(Path(name))
    module, colon, attribute = name.partition(":")
    try:
        reply = getattr(import_module(module), attribute) if colon else None
    except (ImportError, AttributeError, ValueError) as error:
        raise InputError(f"--parser {name[:60]!r} cannot be imported: {error}") from None
    if not callable(reply):
        raise InputError(f"--parser {name[:60]!r} is no URL, no folder of a model, and no module:attribute")
    return ModelParser(reply=reply, name=name)


def cache_folder() -> Path:
    """Where answers are kept: the user's cache."""
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or Path.home() / ".cache"
    return Path(base) / "mmweaver" / "parser"


def _local_parser(folder: Path) -> ModelParser:
    need("pretrained", "--parser with the folder of a model", "transformers")
    import transformers

    chat = transformers.pipeline("text-generation", model=str(folder), trust_remote_code=False)

    def reply(messages: list[dict[str, str]]) -> str:
        form = {"role": "system", "content": f"The JSON schema of the answer: {json.dumps(schema())}"}
        made = chat([form, *messages], max_new_tokens=2048, do_sample=False, return_full_text=False)
        return str(made[0]["generated_text"])

    weights = (sha256_of_file(file) for file in sorted(folder.glob("*.safetensors")))
    digest = hashlib.sha256(" ".join(weights).encode()).hexdigest()
    return ModelParser(reply=reply, name=folder.name, digest=digest[:16], source=digest, cache=cache_folder())


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """Follows no redirect: the key is for the given server alone."""

    def redirect_request(self, req: Any, fp: Any, code: int, msg: str, headers: Any, newurl: str) -> None:
        return None


def _read(response: Any, timeout_s: float) -> bytes:
    """The body, up to `MAX_ANSWER_BYTES` and within the time even if bytes trickle in. Raises OSError beyond."""
    deadline, parts, size = time.monotonic() + timeout_s, [], 0
    while part := response.read1(8192):
        parts.append(part)
        size += len(part)
        if size > MAX_ANSWER_BYTES:
            raise OSError(f"the answer is longer than {MAX_ANSWER_BYTES} bytes")
        if time.monotonic() > deadline:
            raise OSError(f"the answer took longer than {timeout_s:g} s")
    return b"".join(parts)


def _json(answer: str) -> dict[str, Any]:
    if len(answer.encode()) > MAX_ANSWER_BYTES:
        raise InvalidAnswer("the answer is too long")
    fenced = re.fullmatch(r"\s*```(?:json)?\s*(.*?)\s*```\s*", answer, re.DOTALL)
    try:
        found = parse_json(fenced[1] if fenced else answer, "the answer")
    except (InputError, ValueError, RecursionError):
        raise InvalidAnswer("the answer is no JSON") from None
    if not isinstance(found, dict):
        raise InvalidAnswer("the answer is no JSON object")
    return found


def checked(answer: dict[str, Any], text: str) -> dict[str, Any]:
    """The answer if all its names, ranges and words are valid.

    Args:
        answer: The answer.
        text: The sentence.

    Raises:
        InvalidAnswer: Else, with the first reason.
    """
    steps, not_shown = answer.get("steps"), answer.get("not_shown", [])
    if unknown := sorted(set(answer) - {"steps", "not_shown"}):
        raise InvalidAnswer(f"unknown entries: {', '.join(unknown)[:100]}")
    if not isinstance(steps, list) or not 1 <= len(steps) <= MAX_STEPS:
        raise InvalidAnswer(f"steps must be a list of 1 to {MAX_STEPS}")
    for step in steps:
        if not isinstance(step, dict) or "lower" not in step or set(step) - {*_CHOICES, *_NUMBERS, "words"}:
            raise InvalidAnswer(f"a step has lower, words and other entries of the schema alone, not {str(step)[:80]}")
        for name, choices in _CHOICES.items():
            if step.get(name, choices[0]) not in choices:
                raise InvalidAnswer(f"{name} {str(step[name])[:40]!r} is none of the schema")
        for name, (low, high) in _NUMBERS.items():
            value = step.get(name, 0)
            kind = int if name in _INTEGERS else int | float
            if isinstance(value, bool) or not isinstance(value, kind) or not low <= value <= high:
                raise InvalidAnswer(f"{name} must be a number from {low:g} to {high:g}")
        _check_words(step.get("words"), text, least=1)
    _check_words(not_shown, text, least=0)
    stated = [*not_shown, *(word for step in steps for word in step["words"])]
    covered = {word for one in stated for word in _words(one)} | FILLERS | RADAR
    open_words = [word for word in _words(text) if word not in covered and len(word) > 1]
    if open_words:
        raise InvalidAnswer(f"{open_words[0]!r} stands for no step and is not listed in not_shown")
    return answer


def _words(text: str) -> list[str]:
    return _WORD.findall(text.lower())


def _check_words(words: Any, text: str, *, least: int) -> None:
    if not isinstance(words, list) or len(words) < least or not all(isinstance(word, str) for word in words):
        raise InvalidAnswer("words must be a list of words of the sentence")
    known = set(_words(text))
    for word in words:
        if not _words(word) or not set(_words(word)) <= known:
            raise InvalidAnswer(f"{word[:40]!r} does not stand in the sentence")


def plan_of(text: str, answer: dict[str, Any]) -> MotionPlan:
    """The plan of a checked answer, not scheduled yet.

    Args:
        text: The sentence.
        answer: The answer.

    Raises:
        InvalidAnswer: If steps contradict each other.
    """
    steps, records = [], []
    for number, one in enumerate(answer["steps"]):
        clause = " ".join(one["words"])
        fields = {name: one[name] for name in (*_CHOICES, *_NUMBERS) if one.get(name)}
        if direction := fields.pop("direction", ""):
            fields["direction"] = direction_of(direction)
        steps.append(Step(**fields, clause=clause, clauses=(number,)))
        records.append(ClauseRecord(clause))
        stated = {float(NUMBERS.get(word, word)) for word in _words(clause) if word in NUMBERS or word[0].isdigit()}
        if steps[-1].count > 1 and float(steps[-1].count) not in stated:
            raise InvalidAnswer(f"count {steps[-1].count} does not stand in {clause!r}")
    for words in answer.get("not_shown", []):
        records.append(ClauseRecord(words, NOT_DONE, "the model reads no movement in it"))
    try:
        steps = face_things(inherit_state(insert_transitions(steps)), text)
    except InputError as error:
        raise InvalidAnswer(str(error)) from None
    if len(steps) > MAX_STEPS:
        raise InvalidAnswer(f"with what is missing in between there are {len(steps)} steps, {MAX_STEPS} are allowed")
    clauses = add_shown_text(records, steps)
    notes = tuple(clause.sentence for clause in clauses if clause.status == NOT_DONE)
    return MotionPlan(text=text, steps=tuple(steps), clauses=clauses, notes=notes, person=described_person(text))
