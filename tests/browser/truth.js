// Everything in which a contradiction would show; `live` is what the last stream was asked for.
() => {
  const { state, player, result } = studio, control = (name) => document.querySelector(`select[aria-label=${name}]`).value;
  const header = result && {
    radar: result.header.radar, text: result.header.meta.text, seed: result.header.meta.seed, board: result.header.meta.board?.name, people: result.header.people,
  };
  const controls = {
    room: control("Room"), radar: control("Radar"), board: control("Board"), method: control("Method"), seed: Number(document.querySelector(".seed").value),
    text: [...document.querySelectorAll(".sentence")].map((one) => one.value),
  };
  return {
    phase: state.phase, problem: state.problem?.code ?? null, ask: state.ask, shown: state.shown, kept: state.kept, room: state.room, header, controls,
    people: player.scene.people, title: document.querySelector(".shown-title").textContent, plays: result !== null && (player.other ?? player.sequence) === result,
    socket: studio.socket?.readyState ?? null, live: window.lastStream ?? null, stop: document.querySelector(".go button:last-child").textContent,
    marked: document.querySelector(".go button").classList.contains("asked-for"), banner: !document.querySelector(".problem").hidden, frames: Object.values(player.shownFrames()),
  };
}
