// Taking a state elsewhere: links, files, the command line, Python; and arm files that come in.

/** @import { State } from "./state.js" */
/** @import { Setting } from "./types" */

import { armOf, ask } from "./connection.js";
import { byId, toast } from "./page.js";

/** Largest arm file, bytes: what the server takes. */
const LARGEST = 1e6;

/**
 * The command line that gives the same answer.
 * @param {State} state
 */
export function commandLine(state) {
  const set = [...state.set].map(([key, value]) => ` --set ${shellQuoted(`${key}=${value}`)}`).join("");
  return `hydrostat solve ${shellQuoted(fileName(state))}${set}`;
}

/**
 * The Python that gives the same answer.
 * @param {State} state
 */
export function pythonCall(state) {
  const value = (/** @type {Setting} */ v) => (typeof v === "number" ? String(v) : JSON.stringify(v));
  const set = [...state.set].map(([key, v]) => `${JSON.stringify(key)}: ${value(v)}`).join(", ");
  const lines = ["import hydrostat as hs", "", `arm = hs.Arm.load(${JSON.stringify(fileName(state))})`];
  if (set !== "") lines.push(`arm = arm.replace({${set}})`);
  lines.push("sol = arm.solve()", "print(sol.tip)");
  return `${lines.join("\n")}\n`;
}

/** The shipped arm, or the file that the download of the TOML would be. @param {State} state */
function fileName(state) {
  if (state.arm.toml === undefined) return state.arm.name;
  return state.arm.name.endsWith(".toml") ? state.arm.name : `${state.arm.name}.toml`;
}

/** @param {string} text */
function shellQuoted(text) {
  return /^[\w.=/:-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/**
 * @param {string} text
 * @param {string} what
 */
async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    toast(`${what} copied`);
  } catch {
    // Without a secure origin there is no clipboard: then the text is shown to copy by hand.
    window.prompt(what, text);
  }
}

/**
 * @param {Blob} blob
 * @param {string} name
 */
function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  // Some browsers keep the name of a link only while it is on the page, and read what it leads to later.
  link.hidden = true;
  document.body.append(link);
  link.click();
  setTimeout(() => {
    URL.revokeObjectURL(link.href);
    link.remove();
  }, 60_000);
}

/**
 * What the items of the menu do.
 * @param {State} state
 * @param {() => HTMLCanvasElement} view the picture as it is
 */
export function listenToShare(state, view) {
  // What a name of a file cannot have, it has not.
  const stem = () => fileName(state).replace(/\.toml$/, "").replaceAll(/[/\\:*?"<>|]/g, "-");
  const body = (/** @type {Record<string, unknown>} */ more) => ({ arm: armOf(state.arm), set: state.settings(), ...more });
  const download = async (/** @type {string} */ format) => {
    const response = await ask("/api/solve", body({ format }));
    save(await response.blob(), `${stem()}.${format}`);
  };
  /** @type {Record<string, () => unknown>} */
  const items = {
    link: () => copy(location.href, "Link"),
    command: () => copy(commandLine(state), "Command line"),
    python: () => copy(pythonCall(state), "Python call"),
    toml: async () => {
      const { toml } = await (await ask("/api/check", body({}))).json();
      save(new Blob([toml], { type: "application/toml" }), `${stem()}.toml`);
    },
    csv: () => download("csv"),
    json: () => download("json"),
    svg: () => download("svg"),
    pdf: () => download("pdf"),
    png: () => download("png"),
    view: () => view().toBlob((blob) => blob && save(blob, `${stem()}-view.png`)),
  };
  byId("share", HTMLDetailsElement).addEventListener("click", async (event) => {
    const item = event.target instanceof HTMLElement ? event.target.dataset.share : undefined;
    if (!item) return;
    byId("share", HTMLDetailsElement).open = false;
    try {
      await items[item]?.();
    } catch (error) {
      toast(error instanceof Error ? error.message : String(error), "bad");
    }
  });
}

/**
 * Arm files by the button and by drag and drop.
 * @param {State} state
 */
export function listenToFiles(state) {
  const input = byId("file", HTMLInputElement);
  const read = async (/** @type {File | undefined | null} */ file) => {
    if (!file) return;
    try {
      if (file.size > LARGEST) throw new Error(`${file.name} is larger than ${LARGEST / 1e6} MB`);
      const toml = await file.text();
      // A file that is no arm leaves the present one in its place.
      await ask("/api/check", { arm: { toml } });
      state.choose({ name: file.name, toml });
      toast(`${file.name} read`);
    } catch (error) {
      toast(error instanceof Error ? error.message.replace(/^arm:/, `${file.name}:`) : String(error), "bad");
    }
  };
  byId("open-file", HTMLButtonElement).addEventListener("click", () => input.click());
  input.addEventListener("change", async () => {
    await read(input.files?.[0]);
    input.value = "";
  });
  const hint = byId("drop", HTMLElement);
  const files = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files") ?? false;
  window.addEventListener("dragover", (event) => {
    if (!files(event)) return;
    event.preventDefault();
    hint.hidden = false;
  });
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hint.hidden = true;
  });
  window.addEventListener("drop", (event) => {
    if (!files(event)) return;
    event.preventDefault();
    hint.hidden = true;
    read(event.dataTransfer?.files[0]);
  });
}
