// The studio's server. Every call names the session; a session's own rooms and results are nobody else's.
import { unpack, type Packed } from "./wire";

export class Refused extends Error {
  constructor(message: string, readonly waysOn: { label: string; change: Record<string, unknown> }[] = [], readonly code = "input") { super(message); }
}

export class Api {
  session = "";
  readonly token = new URLSearchParams(location.search).get("token") ?? "";

  async open(): Promise<any> {
    const opened = await this.json("api/session", { method: "POST" });
    this.session = opened.session;
    return opened;
  }
  async json(path: string, options: RequestInit = {}): Promise<any> { return (await this.fetch(path, options)).json(); }
  async packed(path: string, options: RequestInit = {}): Promise<Packed> { return unpack(await (await this.fetch(path, options)).arrayBuffer()); }
  /** A file and the name that the server gives it. */
  async file(path: string): Promise<{ name: string; content: Blob }> {
    const answer = await this.fetch(path, {});
    return { name: /filename="([^"]+)"/.exec(answer.headers.get("content-disposition") ?? "")?.[1] ?? "mmweaver", content: await answer.blob() };
  }
  post(body: unknown, signal?: AbortSignal): RequestInit { return { method: "POST", body: JSON.stringify(body), headers: { "content-type": "application/json" }, signal }; }

  socket(path: string): WebSocket {
    const url = new URL(path, location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    url.search = new URLSearchParams({ session: this.session, token: this.token }).toString();
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    return socket;
  }

  private async fetch(path: string, options: RequestInit): Promise<Response> {
    const headers = { ...(options.headers as Record<string, string>), "x-session": this.session, "x-token": this.token };
    let answer: Response;
    try { answer = await fetch(path, { ...options, headers }); } catch (error) {
      if ((error as Error).name === "AbortError") throw error;
      throw new Refused("", [], "offline");
    }
    if (!answer.ok) {
      const said = await answer.json().catch(() => ({}));
      throw new Refused(said.error ?? `the server answered ${answer.status}`, said.ways_on ?? [], said.code);
    }
    return answer;
  }
}
