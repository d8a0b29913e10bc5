// The arm in motion: a clock that the page runs, with what ramps, releases and pulls. Every message asks for a piece of time and is sent when the
// one before was answered, so that no run goes on for a page that has gone.

/** @import { Drawing, Inputs, MotionReply, MotionWish, Place, Point, Reply, Setting, Solution, Stations } from "./types" */
/** @import { Controls } from "./controls.js" */
/** @import { State } from "./state.js" */

import { Chart } from "./chart.js";
import { bodyOf } from "./geometry.js";
import { fixed, number } from "./numbers.js";
import { byId, element } from "./page.js";
import { colours } from "./paint.js";

/** Stations of a moving arm. */
const STATIONS = 81;
/** The longest piece of time that is asked for at once, s: what the server takes. */
const MOST = 0.25;
/** What a step of the clock is at the pace 1, s. */
const STEP = 0.05;
/** Over how much time of the wall it is judged whether the simulation keeps up, s, and from which share of the clock on it does. */
const JUDGED = 1;
const KEEPS_UP = 0.85;
/** Most points of a chart, and time between two of its pictures, ms. */
const POINTS = 1500;
const DRAWN = 120;
/** What may change while the arm moves. */
const LOADS = /^(cable\[\d+\]\.(tension|stroke)|flow\.(speed|direction)(\[\d\])?|gravity\.(acceleration|direction)(\[\d\])?|tip\.(force|moment)(\[\d\])?|arm\.base\.(angle|direction\[\d\]))$/;

/**
 * The shape of a moving arm in the form of an answer, with what is known of it: no forces along the arm.
 * @param {MotionReply} motion
 * @param {Inputs} inputs
 * @returns {Solution}
 */
export function shapeOf({ shape, beta, cables, error_estimate: error }, inputs) {
  const { time: _, ...lists } = shape;
  const alpha = lists.nu.map((nu, i) => (lists.zeta ? Math.atan2(Math.hypot(lists.eta[i], lists.zeta[i]), nu) : Math.atan2(lists.eta[i], nu)));
  /** @type {Stations} */
  const stations = { ...lists, beta, alpha, n_a: [], n_b: [] };
  const last = beta.length - 1;
  const tip = { x: lists.x[last], y: lists.y[last], alpha: alpha[last], theta: lists.theta?.[last], z: lists.z?.[last], a: lists.a?.[last], b: lists.b?.[last], c: lists.c?.[last] };
  const names = (inputs.cable ?? []).map(({ name }) => name);
  return {
    converged: true, stable: null, warnings: [], snaps: [], tip, stations, inputs, error_estimate: error, fold_margin: NaN, statistics: {},
    cables: cables.map((cable, c) => ({ ...cable, name: names[c] ?? String(c), length: NaN })),
    base: { force: [], moment: 0 },
  };
}

export class Clock {
  /**
   * @param {State} state
   * @param {Controls} controls
   * @param {{
   *   send: (wish: MotionWish, stations: number) => number,
   *   show: (moved: { shape: Solution, drawing: Drawing, motion: MotionReply, body: import("./types").Body }) => void,
   *   say: (words: import("./words.js").Words) => void,
   *   still: (why?: string) => void,
   * }} page what it sends has a number, 0 where it cannot be sent; `still` when nothing moves any more and the equilibrium is to be shown
   */
  constructor(state, controls, page) {
    this.state = state;
    this.controls = controls;
    this.page = page;
    this.on = false;
    this.playing = false;
    /** The number of the message whose answer is still to come, or 0. */
    this.waiting = 0;
    /** When the piece of time before was asked for, ms. */
    this.before = 0;
    this.pace = 1;
    /** What goes with the next messages. @type {{ loads: Record<string, Setting>, within: number }[]} */
    this.loads = [];
    /** Whether a run is to begin, and whether the next picture asks for something. */
    this.begins = false;
    this.due = false;
    /** What was asked for last, s. */
    this.asked = 0;
    /** A piece of time that is asked for while the clock stands, s. */
    this.piece = 0;
    /** @type {Place | undefined} */
    this.hold = undefined;
    /** Settings that the run knows. @type {Map<string, Setting>} */
    this.known = new Map();
    /** Loads that were let go, whose sliders stay. @type {Set<string>} */
    this.released = new Set();
    /** @type {Drawing | undefined} */
    this.drawing = undefined;
    /** @type {Inputs | undefined} */
    this.inputs = undefined;
    /** The newest answer. @type {MotionReply | undefined} */
    this.newest = undefined;
    /** What happened, the newest last. @type {string[]} */
    this.events = [];
    /** Time of the wall and of the arm in which the clock ran, s, and what share of it came to be. */
    this.judged = { asked: 0, came: 0, wall: 0 };
    this.keeps = 1;
    this.charts = new MotionCharts(byId("motion-charts", HTMLElement));
    this.listen();
    this.refresh();
  }

  listen() {
    byId("motion", HTMLButtonElement).addEventListener("click", () => (this.on ? this.stop() : this.start()));
    byId("play", HTMLButtonElement).addEventListener("click", () => this.toggle());
    byId("step", HTMLButtonElement).addEventListener("click", () => this.stepOn());
    byId("from-rest", HTMLButtonElement).addEventListener("click", () => this.start());
    byId("pace", HTMLSelectElement).addEventListener("change", (event) => {
      this.pace = Number(/** @type {HTMLSelectElement} */ (event.currentTarget).value);
      this.judge();
      this.refresh();
    });
    byId("ramp-here", HTMLButtonElement).addEventListener("click", () => this.rampHere());
    byId("release", HTMLButtonElement).addEventListener("click", () => this.release(byId("release-load", HTMLSelectElement).value));
    byId("drawing", HTMLCanvasElement).addEventListener("keydown", (event) => {
      if (!this.on || event.ctrlKey || event.metaKey) return;
      if (event.key === " ") this.toggle();
      else if (event.key === ".") this.stepOn();
      else return;
      event.preventDefault();
    });
  }

  // --- What the user does ---------------------------------------------------------------------------------------------

  /** Begins at rest, in the equilibrium of what the sliders say. */
  start() {
    Object.assign(this, { on: true, playing: true, hold: undefined, loads: [], piece: 0, newest: undefined, events: [], drawing: undefined, inputs: undefined });
    this.known = new Map(this.state.set);
    this.released.clear();
    this.charts.clear();
    this.judge();
    this.refresh();
    this.begins = true;
    // The answer that is on its way belongs to the run before.
    if (!this.waiting) this.ask(0);
  }

  /** Back to the equilibrium. @param {string} [why] */
  stop(why) {
    if (!this.on) return;
    Object.assign(this, { on: false, playing: false, waiting: 0, begins: false });
    this.refresh();
    this.page.still(why);
  }

  toggle() {
    if (!this.on || this.newest?.ended) return;
    this.playing = !this.playing;
    this.judge();
    this.refresh();
    this.speak();
    this.go();
  }

  stepOn() {
    if (!this.on || this.newest?.ended) return;
    this.playing = false;
    this.piece += STEP * this.pace;
    this.refresh();
    this.go();
  }

  /** The values of the arm are other ones: loads are led there, else the motion begins again. */
  changed() {
    const { set } = this.state;
    const keys = [...new Set([...set.keys(), ...this.known.keys()])].filter((key) => set.get(key) !== this.known.get(key));
    if (keys.length === 0) return;
    // A cable held by its stroke in place of its tension is another arm.
    const other = keys.some((key) => !LOADS.test(key) || !this.controls.ranges.has(key));
    if (other) {
      this.start();
      return;
    }
    this.known = new Map(set);
    for (const key of keys) this.released.delete(key);
    this.lead(keys, this.within);
  }

  /** How long loads take, s. */
  get within() {
    const value = byId("ramp-time", HTMLInputElement).valueAsNumber;
    return Number.isFinite(value) ? Math.min(Math.max(value, 0), 3600) : 0.2;
  }

  /** All loads to where their sliders are. */
  rampHere() {
    const keys = [...this.controls.ranges.keys()].filter((key) => LOADS.test(key) && (this.state.set.has(key) || this.released.has(key) || key.startsWith("cable")));
    this.released.clear();
    this.lead(keys, this.within);
    if (!this.playing) this.toggle();
  }

  /** Lets go of a cable, of all, or of the load on the tip: by a jump, its slider stays. @param {string} which */
  release(which) {
    const keys = this.releasable().get(which) ?? [];
    for (const key of keys) this.released.add(key);
    this.load(Object.fromEntries(keys.map((key) => [key, 0])), 0);
    if (!this.playing) this.toggle();
  }

  /** What can be let go, with its keys. @returns {Map<string, string[]>} */
  releasable() {
    const keys = [...this.controls.ranges.keys()];
    const tensions = keys.filter((key) => key.endsWith("].tension"));
    /** @type {Map<string, string[]>} */
    const found = new Map(tensions.map((key) => [this.controls.ranges.get(key)?.range.label ?? key, [key]]));
    if (tensions.length > 1) found.set("all cables", tensions);
    found.set("load on the tip", keys.filter((key) => /^tip\.(force|moment)/.test(key)));
    return found;
  }

  /** @param {string[]} keys @param {number} within s */
  lead(keys, within) {
    const values = keys.map((key) => [key, this.state.set.get(key) ?? this.controls.ranges.get(key)?.range.value ?? 0]);
    this.load(Object.fromEntries(values), within);
  }

  /** @param {Record<string, Setting>} loads @param {number} within s */
  load(loads, within) {
    const last = this.loads[this.loads.length - 1];
    if (last && last.within === within) Object.assign(last.loads, loads);
    else this.loads.push({ loads, within });
    this.go();
  }

  /** A hand is at a place. @param {Place} place */
  pull(place) {
    this.hold = place;
    if (!this.playing && !this.newest?.ended) this.toggle();
    else this.go();
  }

  letGo() {
    this.hold = undefined;
  }

  // --- Messages ---------------------------------------------------------------------------------------------------------

  /** Asks for what there is to ask for, at the next picture. */
  go() {
    if (!this.on || this.waiting || this.due) return;
    this.due = true;
    requestAnimationFrame((now) => {
      this.due = false;
      if (!this.on || this.waiting || !this.newest) return;
      if (this.playing) {
        // The time in which a page was out of sight is none of the clock's.
        const wall = Math.min(Math.max(now - this.before, 0) / 1e3, MOST);
        this.before = now;
        this.judged.wall += wall;
        this.judged.asked += wall * this.pace;
        this.ask(Math.min(wall * this.pace, MOST));
      } else if (this.piece > 0 || this.loads.length > 0) {
        const piece = Math.min(this.piece, MOST);
        this.piece -= piece;
        this.ask(piece);
      }
    });
  }

  /** @param {number} by s */
  ask(by) {
    const start = this.begins;
    /** @type {MotionWish} */
    const wish = { by, ...(start ? { start } : this.loads.shift()) };
    const { hold } = this;
    if (hold && !start) wish.hold = this.newest?.shape.z ? hold : hold.slice(0, 2);
    this.begins = false;
    this.asked = by;
    this.waiting = this.page.send(wish, STATIONS);
    if (this.waiting === 0) this.stop("The page is not connected.");
  }

  /** @param {Reply} reply */
  receive(reply) {
    this.waiting = 0;
    if (this.begins) {
      this.ask(0);
      return;
    }
    if (reply.error) {
      this.refused(reply.error);
      return;
    }
    const { motion } = reply;
    if (!motion) return;
    if (reply.drawing) this.drawing = reply.drawing;
    if (motion.inputs) this.inputs = motion.inputs;
    if (!this.drawing || !this.inputs) return;
    const before = this.newest?.shape.time ?? 0;
    this.newest = motion;
    if (this.playing) this.judged.came += motion.shape.time - before;
    // What a step did not come to is still to come.
    else if (!motion.ended) this.piece += Math.max(this.asked - (motion.shape.time - before) - 1e-6, 0);
    this.heard(motion, this.inputs);
    const shape = shapeOf(motion, this.inputs);
    this.charts.add(motion, shape);
    this.page.show({ shape, drawing: this.drawing, motion, body: bodyOf(shape, this.drawing) });
    if (motion.ended) this.playing = false;
    if (motion.ended || this.judged.wall >= JUDGED) this.judge();
    byId("clock-time", HTMLElement).textContent = `t = ${fixed(motion.shape.time, 3)} s`;
    this.refresh();
    this.speak();
    this.go();
  }

  /** @param {import("./types").Problem} problem */
  refused(problem) {
    if (!this.newest || problem.kind === "no_motion" || problem.kind === "time_limit") {
      this.stop(problem.message);
      return;
    }
    // The run is as it was.
    this.page.say({ level: "bad", title: "The request is refused", lines: [problem.message] });
    this.controls.blame(problem.key);
    this.playing = false;
    this.refresh();
  }

  /** Keeps what happened, in words. @param {MotionReply} motion @param {Inputs} inputs */
  heard({ events }, inputs) {
    for (const { time, kind, cable, s } of events) {
      const who = cable === null ? "The surface" : `Cable ${inputs.cable?.[cable]?.name ?? cable}`;
      const what = { slack: "goes slack", taut: "is taut", surface_folds: "folds", surface_unfolds: "unfolds" }[kind] ?? kind.replaceAll("_", " ");
      this.events.push(`${who} ${what} at ${fixed(time, 3)} s${s === null ? "" : `, ${fixed(1e3 * s, 0)} mm from the base`}.`);
    }
    this.events.splice(0, this.events.length - 3);
  }

  /** Whether the simulation keeps up with the clock; begins to judge anew. */
  judge() {
    const { asked, came, wall } = this.judged;
    if (wall >= 0.5 * JUDGED) this.keeps = asked > 0 ? came / asked : 1;
    else this.keeps = 1;
    this.judged = { asked: 0, came: 0, wall: 0 };
    this.before = performance.now();
  }

  get isLate() {
    return this.playing && this.keeps < KEEPS_UP;
  }

  /** The verdict. It stays as it is while the arm moves, so that it is read once. */
  speak() {
    const { newest } = this;
    if (!newest) return;
    if (newest.ended) {
      const { kind, message } = newest.ended;
      const lines = [`${message.charAt(0).toUpperCase()}${message.slice(1)}.`, "The picture and the charts keep what was before. Lower the loads and choose From rest to begin again."];
      this.page.say({ level: "bad", title: `The motion ended: ${kind.replaceAll("_", " ")}`, lines });
      return;
    }
    const lines = [...newest.warnings.map(({ message }) => `${message.charAt(0).toUpperCase()}${message.slice(1)}.`), ...this.events];
    if (this.isLate) lines.unshift("The simulation is slower than the clock: choose a slower time to see it evenly.");
    const title = this.playing ? "In motion" : `In motion; the clock stands at ${fixed(newest.shape.time, 3)} s`;
    this.page.say({ level: this.isLate || newest.warnings.length > 0 ? "warn" : "good", title, lines });
  }

  /** Shows what the clock does. */
  refresh() {
    const { on, playing } = this;
    const ended = this.newest?.ended !== undefined;
    byId("motion", HTMLButtonElement).setAttribute("aria-checked", String(on));
    byId("motion-first", HTMLElement).hidden = on;
    for (const part of document.querySelectorAll("[data-clock]")) if (part instanceof HTMLElement) part.hidden = !on;
    const play = byId("play", HTMLButtonElement);
    const text = playing ? "Pause" : "Play";
    if (play.textContent !== text) play.textContent = text;
    for (const id of ["play", "step", "ramp-here", "release"]) byId(id, HTMLButtonElement).disabled = on && ended;
    const late = byId("clock-late", HTMLElement);
    const words = this.isLate ? `slower than the clock: ${number(this.keeps * this.pace, 1)}\u00d7` : "";
    if (late.textContent !== words) late.textContent = words;
    if (!on) return;
    const select = byId("release-load", HTMLSelectElement);
    const names = [...this.releasable().keys()];
    if (select.dataset.names !== names.join()) {
      select.dataset.names = names.join();
      select.replaceChildren(...names.map((name) => element("option", { value: name, text: name })));
    }
  }
}

/** The tip and the energies over time. */
class MotionCharts {
  /** @param {HTMLElement} place */
  constructor(place) {
    /** @type {{ time: number, tip: number[], energies: number[] }[]} */
    this.rows = [];
    this.drawn = -DRAWN;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.later = undefined;
    /** @param {string} name @param {string[]} lines */
    const made = (name, lines) => {
      const canvas = element("canvas", { role: "img", "aria-label": name });
      const frame = element("div", {}, [canvas]);
      const keys = lines.map((line, k) => element("span", { class: "key" }, [element("i", { class: `dot c${k + 1}` }), line]));
      const unit = element("span");
      place.append(element("figure", { class: "chart" }, [element("figcaption", {}, [element("span", {}, [name, " ", unit]), element("span", { class: "value" }, keys)]), frame]));
      const chart = new Chart(frame, canvas);
      chart.across.title = "t (s)";
      return { chart, canvas, keys, unit, name };
    };
    this.tip = made("Tip over time", ["x", "y", "z"]);
    this.energy = made("Energies over time", ["kinetic", "strain"]);
    new ResizeObserver(() => this.draw()).observe(place);
  }

  clear() {
    this.rows = [];
    this.draw();
  }

  /** @param {MotionReply} motion @param {Solution} shape */
  add({ shape: { time }, kinetic_energy: kinetic, strain_energy: strain, ended }, { tip }) {
    const last = this.rows[this.rows.length - 1];
    if (!last || time > last.time) {
      this.rows.push({ time, tip: [tip.x, tip.y, ...(tip.z === undefined ? [] : [tip.z])], energies: [kinetic, strain] });
      if (this.rows.length > POINTS) this.rows.shift();
    }
    const now = performance.now();
    if (now - this.drawn < DRAWN && !ended) {
      // The last picture before the clock stands is drawn too.
      this.later ??= setTimeout(() => this.draw(), DRAWN);
      return;
    }
    this.draw();
  }

  draw() {
    clearTimeout(this.later);
    this.later = undefined;
    this.drawn = performance.now();
    const colour = colours();
    const [ink, quiet, line, card, accent] = ["ink", "quiet", "line", "card", "accent"].map(colour);
    const most = this.rows.reduce((all, { energies }) => Math.max(all, ...energies), 0);
    const [factor, unit] = most < 1e-4 ? [1e6, "\u00b5J"] : most < 0.1 ? [1e3, "mJ"] : [1, "J"];
    for (const [one, of, scale, name] of /** @type {const} */ ([[this.tip, "tip", 1e3, "mm"], [this.energy, "energies", factor, unit]])) {
      one.chart.look = { ink, quiet, line, card, accent };
      const count = Math.max(...this.rows.slice(-1).map((row) => row[of].length), one.keys.length - 1);
      one.keys.forEach((key, k) => {
        key.hidden = k >= count && of === "tip";
      });
      one.unit.textContent = `(${name})`;
      const lines = Array.from({ length: of === "tip" ? count : 2 }, (_, k) => ({
        points: this.rows.map((row) => /** @type {Point} */ ([row.time, scale * row[of][k]])), colour: colour(`series-${k + 1}`),
      }));
      one.chart.show(lines);
      const end = this.rows[this.rows.length - 1];
      one.canvas.setAttribute("aria-label", end ? `${one.name} from ${fixed(this.rows[0].time, 2)} to ${fixed(end.time, 2)} s, ${one.chart.words(name)}` : `${one.name}: nothing yet`);
    }
  }
}
