"""A stream of sentences: one signal in running time, the same bits however it is cut, and noise that never repeats."""

from collections.abc import Iterator

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from mmweaver.weaver.streaming import StreamChunk

SENTENCES = ("a person waves", "a person claps")


@pytest.fixture(scope="module")
def weaver() -> Weaver:
    return Weaver()


@pytest.fixture(scope="module")
def room(weaver: Weaver) -> Room:
    return weaver.sample_room()


@pytest.fixture(scope="module")
def chunks(weaver: Weaver, room: Room) -> list[StreamChunk]:
    return list(weaver.stream(room, SENTENCES, seed=2))


def values(chunks: list[StreamChunk]) -> np.ndarray:
    return np.concatenate([chunk.cube.values for chunk in chunks])


def test_radar_time_runs_on_over_chunks_and_sentences(chunks: list[StreamChunk]):
    time_s = np.concatenate([chunk.cube.grid.frame_time_s for chunk in chunks])
    np.testing.assert_allclose(time_s, np.arange(len(time_s)) / 10, atol=1e-12)
    np.testing.assert_array_equal(time_s, np.concatenate([chunk.pose.time_s for chunk in chunks]))
    assert [chunk.text for chunk in chunks] == sorted((chunk.text for chunk in chunks), reverse=True)
    for chunk in chunks:
        assert chunk.motion.time_s[0] < chunk.pose.time_s[0]
        assert chunk.motion.time_s[-1] >= chunk.pose.time_s[-1]
        assert chunk.points.frame.max(initial=0) < chunk.num_frames


def test_chunks_of_another_size_hold_the_same_bits(weaver: Weaver, room: Room, chunks: list[StreamChunk]):
    others = list(weaver.stream(room, SENTENCES, seed=2, chunk_frames=7))
    np.testing.assert_array_equal(values(chunks), values(others))
    np.testing.assert_array_equal(
        np.concatenate([one.points.x_m for one in chunks]), np.concatenate([one.points.x_m for one in others])
    )


def test_the_first_sentence_is_that_of_generate_and_noise_does_not_repeat(
    weaver: Weaver, room: Room, chunks: list[StreamChunk]
):
    alone = weaver.generate(room, SENTENCES[0], seed=2)
    assert chunks[0].motion.subject == alone.motion.subject
    noise = values(chunks)[:, -10:, :3].reshape(len(values(chunks)), -1)  # far away, as fast as nobody is
    size = np.linalg.norm(noise, axis=1)
    likeness = np.abs(noise @ noise.conj().T) / np.outer(size, size)
    assert np.triu(likeness, 1).max() < 0.35


def test_static_clutter_is_the_same_throughout(chunks: list[StreamChunk]):
    means = [
        np.mean([chunk.cube.values[:, :, 16].mean(axis=0) for chunk in chunks if chunk.text == text], axis=0)
        for text in SENTENCES
    ]  # at rest
    one, other = means
    assert abs(np.vdot(one, other)) > 0.5 * np.linalg.norm(one) * np.linalg.norm(other)


def test_a_live_source_is_asked_when_the_next_sentence_is_due(weaver: Weaver, room: Room):
    asked: list[int] = []

    def live() -> Iterator[str | None]:
        yield "a person waves"
        asked.append(1)
        yield None
        asked.append(2)
        yield "xyzzy blorps"
        asked.append(3)
        yield ""
        yield "sits down"

    seen = []
    for chunk in weaver.stream(room, live(), chunk_frames=4):
        seen.append(chunk)
        assert chunk.num_frames <= 4
        assert chunk.text != "sits down" or asked[-1] == 3
    time_s = np.concatenate([chunk.cube.grid.frame_time_s for chunk in seen])
    np.testing.assert_allclose(np.diff(time_s), 0.1, atol=1e-9)
    assert sum("xyzzy" in chunk.refused for chunk in seen) == 1
    assert {chunk.text for chunk in seen} == {"a person waves", "sits down"}


def test_the_ray_tracer_streams_with_the_same_bits_in_chunks_of_any_size(room: Room):
    physics = Weaver("physics")
    parts = [values(list(physics.stream(room, ["a person claps"], chunk_frames=size))) for size in (10, 6)]
    np.testing.assert_array_equal(*parts)


def test_what_cannot_be_streamed_is_refused(weaver: Weaver, room: Room):
    with pytest.raises(InputError, match="xyzzy"):
        next(weaver.stream(room, ["xyzzy blorps"]))
    with pytest.raises(InputError, match="chunk_frames"):
        weaver.stream(room, [], chunk_frames=0)

    def old_method(scene, poses, config, *, num_frames, seed, keep_adc, stages, background=None): ...

    with pytest.raises(InputError, match="first_frame"):
        Weaver(old_method).stream(room, [])  # type: ignore[arg-type]
    assert list(weaver.stream(room, [])) == []


def test_the_first_frames_of_a_chunk_are_a_chunk(chunks: list[StreamChunk]):
    whole = chunks[0]
    some = whole.first(4)
    assert some.num_frames == len(some.pose.joints_m) == len(some.cube.grid.frame_time_s) == 4
    np.testing.assert_array_equal(some.cube.values, whole.cube.values[:4])
    assert some.points.frame.max(initial=0) < 4
    assert some.first_frame == whole.first_frame
