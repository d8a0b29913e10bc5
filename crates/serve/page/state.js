// What the page shows: an arm and what is different from its file. All of it fits into the address, which can be shared.

/** @import { ArmChoice, Setting } from "./types" */

export class State {
  constructor() {
    /** @type {ArmChoice} */
    this.arm = { name: "paper" };
    /** Values by dotted key, in the units of the arm file. @type {Map<string, Setting>} */
    this.set = new Map();
    /** @type {((what: "arm" | "set") => void)[]} */
    this.listeners = [];
  }

  /** @param {(what: "arm" | "set") => void} listener */
  onChange(listener) {
    this.listeners.push(listener);
  }

  /** @param {"arm" | "set"} what */
  changed(what) {
    for (const listener of this.listeners) listener(what);
  }

  /**
   * Another arm, as its file has it or with overrides.
   * @param {ArmChoice} arm
   * @param {Iterable<[string, Setting]>} [set]
   */
  choose(arm, set = []) {
    this.arm = arm;
    this.set = new Map(set);
    this.changed("arm");
  }

  /**
   * Overrides values; undefined takes the file's again.
   * @param {Record<string, Setting | undefined>} values
   * @param {boolean} [quietly] without telling anyone
   */
  change(values, quietly = false) {
    for (const [key, value] of Object.entries(values)) {
      if (value === undefined) this.set.delete(key);
      else this.set.set(key, value);
    }
    if (!quietly) this.changed("set");
  }

  /** @returns {Record<string, Setting>} */
  settings() {
    return Object.fromEntries(this.set);
  }

  /** The part of the address after #. */
  async toHash() {
    const parts = new URLSearchParams();
    parts.set("arm", this.arm.name);
    if (this.arm.toml !== undefined) parts.set("toml", await packed(this.arm.toml));
    for (const [key, value] of this.set) parts.set(key, String(value));
    // Brackets and dots need no escape, and people read addresses.
    return parts.toString().replaceAll("%5B", "[").replaceAll("%5D", "]").replaceAll("%2F", "/");
  }

  /**
   * Takes what an address says; false where it says nothing.
   * @param {string} hash
   */
  async fromHash(hash) {
    const parts = new URLSearchParams(hash.replace(/^#/, ""));
    const name = parts.get("arm");
    if (name === null) return false;
    const text = parts.get("toml");
    /** @type {ArmChoice} */
    const arm = text === null ? { name } : { name, toml: await unpacked(text) };
    /** @type {[string, Setting][]} */
    const set = [];
    for (const [key, value] of parts) {
      if (key !== "arm" && key !== "toml") set.push([key, value.trim() !== "" && Number.isFinite(Number(value)) ? Number(value) : value]);
    }
    this.choose(arm, set);
    return true;
  }
}

/** @param {string} text */
async function packed(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let binary = "";
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** @param {string} text */
async function unpacked(text) {
  const binary = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Response(stream).text();
}
