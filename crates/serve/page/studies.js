// What takes longer than a solve: paths, readings side by side, all equilibria. They come over the HTTP interface.

/** @import { Answer, Body, Drawing, EquilibriaDocument, Options, PathDocument, Solution, Tip } from "./types" */
/** @import { ArmView } from "./arm_view.js" */
/** @import { Controls, Range } from "./controls.js" */
/** @import { State } from "./state.js" */

import { PathCharts } from "./charts.js";
import { armOf, ask } from "./connection.js";
import { bodyOf, bodyOfShape } from "./geometry.js";
import { degrees, fixed } from "./numbers.js";
import { byId, element, toast } from "./page.js";

const STATIONS = 121;

/** A table. @param {string[]} head @param {(string | Node)[][]} rows */
function table(head, rows) {
  return element("table", {}, [
    element("thead", {}, [element("tr", {}, head.map((text) => element("th", { scope: "col", text })))]),
    element("tbody", {}, rows.map((cells) => element("tr", {}, cells.map((cell) => element("td", {}, [cell]))))),
  ]);
}

/** @param {unknown} error */
const said = (error) => (error instanceof Error ? error.message : String(error));

export class Studies {
  /**
   * @param {State} state
   * @param {ArmView} view
   * @param {Controls} controls
   * @param {() => { shape: Solution, drawing: Drawing } | undefined} present
   */
  constructor(state, view, controls, present) {
    this.state = state;
    this.view = view;
    this.controls = controls;
    this.present = present;
    /** @type {Range | undefined} */
    this.track = undefined;
    /** What can be chosen, as the server says. @type {Options} */
    this.options = { readings: [], flow_law: { key: "flow.law", label: "", meaning: "", words: [] } };
    /** Counts states: what was asked of an earlier one comes too late. */
    this.epoch = 0;
    /** What the path that is shown is of. */
    this.traced = "";
    this.paths = new PathCharts(byId("path-charts", HTMLElement), (value) => {
      if (this.track) this.state.change({ [this.track.key]: value / this.track.per });
    });
    byId("path-key", HTMLSelectElement).addEventListener("change", () => this.chooseTrack());
    byId("path-form", HTMLFormElement).addEventListener("submit", (event) => {
      event.preventDefault();
      this.trace();
    });
    byId("search", HTMLButtonElement).addEventListener("click", () => this.search());
  }

  body() {
    return { arm: armOf(this.state.arm), set: this.state.settings() };
  }

  /** The panel of controls is another one. */
  rebuilt() {
    const select = byId("path-key", HTMLSelectElement);
    const before = select.value;
    const tracks = this.controls.tracks();
    select.replaceChildren(...tracks.map(({ key }) => element("option", { value: key, text: key })));
    if (tracks.some(({ key }) => key === before)) select.value = before;
    this.chooseTrack();
  }

  /** The state is another one: what was found of the one before does not hold. */
  outdated() {
    this.epoch += 1;
    if (this.view.scene.extra) this.view.scene.extra = undefined;
    byId("all-table", HTMLElement).replaceChildren();
    byId("all-words", HTMLElement).textContent = "";
    byId("all-picture", HTMLImageElement).hidden = true;
    if (this.traced !== "" && this.traced !== this.others()) {
      this.traced = "";
      this.view.scene.way = [];
      byId("path-words", HTMLElement).textContent = "The other loads have changed: trace again.";
    }
  }

  /** All that a path is of: arm and values but the one that varies. */
  others() {
    return JSON.stringify([this.state.arm, [...this.state.set].filter(([key]) => key !== this.track?.key)]);
  }

  chooseTrack() {
    const key = byId("path-key", HTMLSelectElement).value;
    this.track = this.controls.tracks().find((track) => track.key === key);
    if (!this.track) return;
    const { min, max, per, unit } = this.track;
    byId("path-from", HTMLInputElement).value = String(Number((min * per).toPrecision(6)));
    byId("path-to", HTMLInputElement).value = String(Number((max * per).toPrecision(6)));
    byId("path-unit", HTMLElement).textContent = unit;
  }

  /** The equilibria over the range that the form has. */
  async trace() {
    const { track } = this;
    const words = byId("path-words", HTMLElement);
    if (!track) return;
    const [from, to] = [byId("path-from", HTMLInputElement), byId("path-to", HTMLInputElement)].map((box) => box.valueAsNumber / track.per);
    const settings = this.state.settings();
    words.textContent = "Tracing\u2026";
    const { epoch } = this;
    try {
      const vary = `${track.key}=${from}:${to}`;
      const response = await ask("/api/path", { arm: armOf(this.state.arm), set: settings, vary, max_points: 600 });
      /** @type {PathDocument} */
      const path = await response.json();
      if (epoch !== this.epoch) {
        words.textContent = "The loads have changed: trace again.";
        return;
      }
      this.traced = this.others();
      const angle = path.unit === "rad";
      const shown = (/** @type {number} */ si) => (angle ? degrees(si) : si) * track.per;
      this.paths.show(path, `${track.key}${track.unit ? ` (${track.unit})` : ""}`, shown);
      const points = path.branches[0]?.points ?? [];
      this.view.scene.way = points.map(({ tip, stability, event }) => ({ place: [tip.x, tip.y, tip.z ?? 0], stable: stability.state === "stable", event }));
      if (this.view.fitted) this.view.fit();
      else this.view.paint();
      words.textContent = pathWords(path);
    } catch (error) {
      words.textContent = said(error);
    }
  }

  /** This arm under each alternative reading. */
  async compare() {
    const place = byId("readings-table", HTMLElement);
    const present = this.present();
    if (!present) return;
    const { epoch } = this;
    const own = this.state.settings();
    const base = present.shape;
    const chosen = base.inputs.model;
    /** @type {{ label: string, word: string, meaning: string, key: string | null }[]} */
    const cases = [{ label: "As chosen", word: "", meaning: "", key: null }];
    for (const { key, label, words } of this.options.readings) {
      const others = words.filter(({ word }) => word !== chosen[key.replace("model.", "")]);
      cases.push(...others.map(({ word, meaning }) => ({ label, word, meaning, key })));
    }
    /** @type {(string | Node)[][]} */
    const rows = [];
    for (const { label, word, meaning, key } of cases) {
      const set = key === null ? own : { ...own, [key]: word };
      const name = key === null ? label : `${label}: ${word}`;
      try {
        const response = await ask("/api/solve", { arm: armOf(this.state.arm), set, stations: STATIONS });
        if (epoch !== this.epoch) return;
        rows.push(this.reading(name, meaning, await response.json(), present));
      } catch (error) {
        rows.push([name, ...placeCells(base.tip).map(() => ""), "", "", said(error)]);
      }
      place.replaceChildren(table(["Reading", ...placeHeads(base.tip), "\u03b1(L) (\u00b0)", "Tip moves (mm)", "Verdict"], rows));
      this.choosableRows("readings-table");
    }
  }

  /**
   * @param {string} name
   * @param {string} meaning
   * @param {Answer} answer
   * @param {{ shape: Solution, drawing: Drawing }} present
   * @returns {(string | Node)[]}
   */
  reading(name, meaning, answer, present) {
    const { tip: own } = present.shape;
    if (!answer.converged) return [name, ...placeCells(own).map(() => ""), "", "", answer.verdict.message];
    const { tip } = answer;
    const moved = 1e3 * Math.hypot(tip.x - own.x, tip.y - own.y, (tip.z ?? 0) - (own.z ?? 0));
    const button = this.chooser("readings-table", name, bodyOf(answer, present.drawing));
    button.title = meaning;
    if (meaning !== "") button.setAttribute("aria-description", meaning);
    const stable = answer.stable === true ? "stable" : answer.stable === false ? "unstable" : "stability not established";
    const words = [stable, ...answer.warnings.map((w) => w.kind.replaceAll("_", " "))].join(", ");
    return [button, ...placeCells(tip), fixed(degrees(tip.alpha), 3), fixed(moved, 3), words];
  }

  /**
   * A button that shows a shape in the picture, or takes it away again.
   * @param {string} table the table that it is in, whose others are then not chosen
   * @param {string} text
   * @param {Body} body
   */
  chooser(table, text, body) {
    const button = element("button", { type: "button", text, "aria-pressed": "false" });
    button.addEventListener("click", () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      for (const other of byId(table, HTMLElement).querySelectorAll("button")) other.setAttribute("aria-pressed", "false");
      button.setAttribute("aria-pressed", String(on));
      this.overlay(on ? body : undefined);
      if (on) this.view.canvas.scrollIntoView({ block: "nearest" });
    });
    return button;
  }

  /** @param {Body | undefined} body */
  overlay(body) {
    this.view.scene.extra = body;
    this.view.paint();
  }

  /** The button of one of all equilibria. @param {EquilibriaDocument} all @param {number} i */
  numbered({ shapes }, i) {
    if (!shapes?.[i]) return String(i + 1);
    const button = this.chooser("all-table", String(i + 1), bodyOfShape(shapes[i]));
    button.setAttribute("aria-label", `Show equilibrium ${i + 1} in the picture`);
    return button;
  }

  /** A click anywhere on a row is one on its button. @param {string} table */
  choosableRows(table) {
    for (const row of byId(table, HTMLElement).querySelectorAll("tbody tr")) {
      const button = row.querySelector("button");
      if (!button) continue;
      row.classList.add("choosable");
      row.addEventListener("click", (event) => {
        if (event.target instanceof Node && !button.contains(event.target)) button.click();
      });
    }
  }

  /** All equilibria under the present loads. */
  async search() {
    const words = byId("all-words", HTMLElement);
    const { epoch } = this;
    words.textContent = "Searching\u2026";
    try {
      /** @type {EquilibriaDocument} */
      const all = await (await ask("/api/equilibria", { ...this.body(), stations: STATIONS })).json();
      const picture = await (await ask("/api/equilibria", { ...this.body(), format: "svg" })).blob();
      if (epoch !== this.epoch) return;
      const stable = all.equilibria.filter((one) => one.stability.state === "stable").length;
      const whole = all.complete ? "These are all." : all.curves !== undefined ? inSpaceWords(all) : `The search is not complete: ${all.ends.flatMap((end) => end?.message ?? []).join("; and ")}.`;
      words.textContent = `${all.equilibria.length} found, ${stable} of them stable. ${whole}`;
      const first = all.equilibria[0]?.tip;
      const heads = first === undefined ? [] : [...placeHeads(first), ...(first.theta === undefined ? [] : ["Turned (\u00b0)"])];
      const row = (/** @type {EquilibriaDocument["equilibria"][number]} */ { tip, stability }, /** @type {number} */ i) => [
        this.numbered(all, i), ...placeCells(tip), ...(tip.theta === undefined ? [] : [fixed(degrees(tip.theta), 3)]), fixed(degrees(tip.alpha), 3),
        stability.state === "unstable" ? `unstable (${stability.directions})` : stability.state ?? "not established",
      ];
      byId("all-table", HTMLElement).replaceChildren(table(["Number", ...heads, "\u03b1(L) (\u00b0)", "Stability"], all.equilibria.map(row)));
      this.choosableRows("all-table");
      const image = byId("all-picture", HTMLImageElement);
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(picture);
      image.alt = `All ${all.equilibria.length} shapes to scale`;
      image.hidden = false;
    } catch (error) {
      words.textContent = "";
      toast(said(error), "bad");
    }
  }
}

/** The heads of a tip's coordinates. @param {Tip} tip */
const placeHeads = (tip) => ["Tip x (mm)", "Tip y (mm)", ...(tip.z === undefined ? [] : ["Tip z (mm)"])];
/** Its coordinates, mm. @param {Tip} tip */
const placeCells = ({ x, y, z }) => [x, y, ...(z === undefined ? [] : [z])].map((v) => fixed(1e3 * v, 3));

/** How far a search in space went. @param {EquilibriaDocument} all */
function inSpaceWords({ curves, misses_some: some }) {
  return `${some ? "At least one is missing" : "There may be others"}: ${curves} curves over turns of the base were followed.`;
}

/** @param {PathDocument} path */
function pathWords(path) {
  const [first] = path.branches;
  if (!first) return "No point of the path was found.";
  const count = (/** @type {string} */ event) => first.points.filter((p) => p.event === event).length;
  const unstable = first.points.filter((p) => p.stability.state === "unstable").length;
  const many = (/** @type {number} */ n, /** @type {string} */ one) => `${n === 0 ? "no" : n} ${one}${n === 1 ? "" : "s"}`;
  const stability = unstable === 0 ? "stable all along" : `unstable at ${unstable} of them (dotted)`;
  return `${many(first.points.length, "point")}, ${stability}; ${many(count("limit_point"), "limit point")}, ${many(count("bifurcation"), "bifurcation")}. The path ends: ${first.end.message}. A click on a chart goes to that shape.`;
}
