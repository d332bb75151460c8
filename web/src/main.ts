// The entries of the bundle: the studio, a page that plays one result without a server, and a notebook widget.
import css from "./page.css";
import { element } from "./dom";
import { Player } from "./player";
import { RoomView, Sequence } from "./sequence";
import { Studio } from "./studio";
import { unpack } from "./wire";

function style(at: HTMLElement): void { at.append(element("style", {}, css)); }

export async function mountStudio(at: HTMLElement): Promise<Studio> {
  style(document.head);
  const studio = new Studio();
  at.append(studio.root);
  (window as any).studio = studio;
  await studio.start();
  return studio;
}

/** Plays packed bytes, a sequence and, where there is one, its room. */
export function mountPlayer(at: HTMLElement, sequence: ArrayBuffer, room: ArrayBuffer | null): Player {
  style(at);
  const player = new Player(), shown = new Sequence(unpack(sequence)), meta = shown.header.meta;
  at.classList.add("mmweaver");
  at.append(element("p", { class: "status" }, [meta.text ?? "", shown.header.radar].flat().filter(Boolean).join(" · ")), player.root);
  if (room) player.setRoom(new RoomView(unpack(room)));
  player.show(shown);
  document.addEventListener("keydown", (event) => { if (!(event.target as HTMLElement).closest(".player")) player.key(event); });
  (window as any).player = player;
  return player;
}

/** A page with its data inside: base64 in <script type="application/octet-stream" id="sequence"> and id="room". */
export function mountOffline(): Player {
  const bytes = (id: string) => {
    const holder = document.getElementById(id);
    return holder ? Uint8Array.from(atob(holder.textContent!.trim()), (c) => c.charCodeAt(0)).buffer : null;
  };
  return mountPlayer(document.getElementById("page")!, bytes("sequence")!, bytes("room"));
}

if (document.body?.dataset.page === "studio") void mountStudio(document.body);
else if (document.body?.dataset.page === "offline") mountOffline();

/** anywidget's protocol. */
export default {
  render({ model, el }: { model: { get(name: string): DataView | null }; el: HTMLElement }): () => void {
    const bytes = (name: string) => { const view = model.get(name); return view ? (view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength) as ArrayBuffer) : null; };
    const place = element("div", { style: "height:720px" });
    el.append(place);
    const player = mountPlayer(place, bytes("sequence")!, bytes("room"));
    return () => player.scene.dispose();
  },
};
