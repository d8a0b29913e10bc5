// The conversation with the server. Wishes may be sent faster than they are answered: the server answers the newest that waits.

/** @import { ArmChoice, Reply, Wish } from "./types" */

const FIRST_DELAY = 300;
const LONGEST_DELAY = 5000;

export class Connection {
  /**
   * @param {(reply: Reply, asked: number) => void} onReply with the time at which the answered wish came to be
   * @param {(open: boolean) => void} onState
   */
  constructor(onReply, onState) {
    this.onReply = onReply;
    this.onState = onState;
    this.id = 0;
    /** When each wish that has no answer came to be. @type {Map<number, number>} */
    this.asked = new Map();
    /** @type {Wish | undefined} */
    this.latest = undefined;
    /** The arm that the server has. @type {ArmChoice | undefined} */
    this.arm = undefined;
    this.delay = FIRST_DELAY;
    /** @type {WebSocket | undefined} */
    this.socket = undefined;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/api/session`);
    this.socket = socket;
    socket.addEventListener("open", () => {
      this.delay = FIRST_DELAY;
      this.arm = undefined;
      this.asked.clear();
      this.onState(true);
      if (this.latest) this.send(this.latest);
    });
    socket.addEventListener("message", (event) => {
      /** @type {Reply} */
      const reply = JSON.parse(event.data);
      const asked = this.asked.get(reply.id) ?? performance.now();
      for (const id of this.asked.keys()) if (id <= reply.id) this.asked.delete(id);
      this.onReply(reply, asked);
    });
    socket.addEventListener("close", () => {
      this.onState(false);
      setTimeout(() => this.open(), this.delay);
      this.delay = Math.min(2 * this.delay, LONGEST_DELAY);
    });
  }

  /**
   * @param {Wish} wish
   * @param {number} [asked] when the user wished it
   * @returns {number} its number; 0 where there is no connection
   */
  send(wish, asked = performance.now()) {
    // A run ends with its connection: what is asked of it is not asked again.
    if (!wish.motion) this.latest = wish;
    if (this.socket?.readyState !== WebSocket.OPEN) return 0;
    this.id += 1;
    this.asked.set(this.id, asked);
    const { arm, ...rest } = wish;
    /** @type {Record<string, unknown>} */
    const message = { id: this.id, ...rest };
    if (arm !== this.arm) {
      message.arm = arm.toml === undefined ? arm.name : { toml: arm.toml };
      this.arm = arm;
    }
    this.socket.send(JSON.stringify(message));
    return this.id;
  }
}

/**
 * Asks the HTTP interface.
 * @param {string} path
 * @param {unknown} [body]
 * @returns {Promise<Response>}
 */
export async function ask(path, body) {
  const options = body === undefined ? {} : { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const response = await fetch(path, options);
  if (response.ok) return response;
  const problem = await response.json().catch(() => null);
  throw new Error(problem?.error?.message ?? `the server answered ${response.status}`);
}

/**
 * The arm of a body for the HTTP interface.
 * @param {ArmChoice} arm
 */
export const armOf = (arm) => (arm.toml === undefined ? arm.name : { toml: arm.toml });
