// Puts the page together: what is wished goes to the server, what comes back to drawing, words, numbers and charts.

/** @import { Body, Drawing, Options, Place, Reply, Setting, Solution, Wish } from "./types" */
/** @import { Range } from "./controls.js" */

import { ArmView } from "./arm_view.js";
import { AlongCharts } from "./charts.js";
import { Connection, armOf, ask } from "./connection.js";
import { Controls } from "./controls.js";
import { directionOf } from "./camera.js";
import { bodyOf, bodyOfShape, stationAt } from "./geometry.js";
import { listenToHelp } from "./help.js";
import { Clock } from "./motion.js";
import { fixed, force } from "./numbers.js";
import { byId, element, kept, settled, tidyMenus, toast } from "./page.js";
import { listenToFiles, listenToShare } from "./share.js";
import { State } from "./state.js";
import { Studies } from "./studies.js";
import { numbersOf, numbersOfMotion, wordsOf, wordsOfPull } from "./words.js";

/** Most shapes that are kept to compare with. */
const PINS = 4;
/** How long raising a load from zero takes, ms. */
const RAMP = 6000;

const state = new State();
/** What is looked at. @type {{ shape: Solution, drawing: Drawing, asked: boolean } | undefined} */
let present;
/** @type {{ shape: Solution, body: Body, colour: number, label: string }[]} */
let pins = [];
/** Whether the tip has been let go and the last answer to a pull is still to come. */
let letGo = false;
let pulling = false;
/** Stops what raises a load. @type {(() => void) | undefined} */
let stopRamp;

const hover = (/** @type {number | undefined} */ s) => {
  along.hover(s);
  view.hover(s === undefined || !present ? undefined : stationAt(present.shape.stations.s, s));
};
const view = new ArmView(pull, release, hover);
const along = new AlongCharts(byId("along", HTMLElement), hover);
const controls = new Controls(byId("controls", HTMLElement), state, ramp);
const clock = new Clock(state, controls, {
  send: (motion, stations) => {
    const { arm, set } = wish();
    return connection.send(motion.start ? { arm, set, stations, motion } : { arm, set: {}, motion });
  },
  show: moved,
  say: (words) => say(words),
  still,
});
const connection = new Connection(receive, (open) => {
  byId("link", HTMLElement).textContent = open ? "" : "not connected";
  byId("took", HTMLElement).hidden = !open;
  if (!open) clock.stop();
  if (!open) say({ level: "bad", title: "Not connected", lines: ["The server does not answer. Is `hydrostat serve` still running? The page reconnects automatically."] });
});
const studies = new Studies(state, view, controls, () => (present?.asked ? present : undefined));

controls.strokeOf = (/** @type {number} */ c) => Number((present?.shape.cables[c]?.stroke ?? 0).toPrecision(6));
controls.tensionOf = (/** @type {number} */ c) => Number((present?.shape.cables[c]?.tension ?? 0).toPrecision(6));

/** @returns {Wish} */
const wish = () => ({ arm: state.arm, set: state.settings() });

// --- What the user does ---------------------------------------------------------------------------------------------

const remember = settled(250, async () => {
  history.replaceState(null, "", `#${await state.toHash()}`);
});
const compareSoon = settled(400, () => {
  if (!byId("readings", HTMLElement).hidden) studies.compare();
});

state.onChange(async (what) => {
  studies.outdated();
  if (what === "arm") {
    clock.stop();
    view.clear();
    present = undefined;
    try {
      await build();
    } catch (error) {
      refused({ kind: "", field: "arm", key: null, line: null, message: error instanceof Error ? error.message : String(error) });
      return;
    }
  }
  // The server works while the panel is brought up to date.
  if (!clock.on) connection.send(wish(), controls.moved || undefined);
  controls.moved = 0;
  controls.refresh();
  if (clock.on) clock.changed();
  remember();
  compareSoon();
});

/** The panel and the choice of arms for the present arm. */
async function build() {
  const { inputs, tension_scale: scale } = await (await ask("/api/check", { arm: armOf(state.arm) })).json();
  controls.build(inputs, scale);
  studies.rebuilt();
  const select = byId("arm", HTMLSelectElement);
  if (![...select.options].some((option) => option.value === state.arm.name)) select.append(element("option", { value: state.arm.name, text: state.arm.name }));
  select.value = state.arm.name;
  if (state.arm.toml !== undefined) own.set(state.arm.name, state.arm.toml);
}

/** Arms that came as files, by their names. @type {Map<string, string>} */
const own = new Map();

byId("arm", HTMLSelectElement).addEventListener("change", (event) => {
  const name = /** @type {HTMLSelectElement} */ (event.currentTarget).value;
  const toml = own.get(name);
  state.choose(toml === undefined ? { name } : { name, toml });
});

/** @param {Place} place @param {number} asked */
function pull(place, asked) {
  if (clock.on) {
    clock.pull(place);
    return;
  }
  stopRamp?.();
  pulling = true;
  letGo = false;
  const most = Math.max(...controls.most, 0);
  const target = present?.shape.stations.z ? place : place.slice(0, 2);
  connection.send({ ...wish(), target, ...(most > 0 ? { max_tension: most } : {}) }, asked);
}

function release() {
  if (clock.on) {
    clock.letGo();
    return;
  }
  letGo = true;
  if (connection.asked.size === 0) endPull();
}

/** The tensions that the pull led to are the state from now on. */
function endPull() {
  pulling = false;
  letGo = false;
  connection.send(wish());
  remember();
  compareSoon();
}

/**
 * Raises a load from zero to the end of its slider; where there is no shape any more it stops.
 * @param {string} key
 * @param {Range} range
 */
function ramp(key, range) {
  clock.stop();
  if (stopRamp) {
    stopRamp();
    return;
  }
  view.scene.trail = [];
  const start = performance.now();
  const from = Math.max(range.min, 0);
  let running = true;
  stopRamp = () => {
    running = false;
    stopRamp = undefined;
  };
  const step = (/** @type {number} */ now) => {
    if (!running) return;
    if (present && !present.asked) {
      stopRamp?.();
      return;
    }
    const share = Math.min((now - start) / RAMP, 1);
    if (connection.asked.size === 0) state.change({ [key]: Number((from + share * (range.max - from)).toPrecision(5)) });
    if (share < 1) requestAnimationFrame(step);
    else stopRamp?.();
  };
  state.change({ [key]: from });
  requestAnimationFrame(step);
}

// --- What the server says --------------------------------------------------------------------------------------------

/** The latest times from wish to picture, ms: for whoever measures. @type {number[]} */
const latencies = [];
Object.assign(globalThis, { hydrostatLatencies: latencies });

/** Nobody reads faster than this, ms, and every change has the page laid out anew. */
const READABLE = 250;
let tookSaid = -READABLE;
/** @param {string} text @param {string} title */
function sayTook(text, title) {
  const now = performance.now();
  if (now - tookSaid < READABLE) return;
  tookSaid = now;
  const took = byId("took", HTMLElement);
  [took.textContent, took.title] = [text, title];
}

/** @param {Reply} reply @param {number} asked */
function receive(reply, asked) {
  if (reply.ghost) view.scene.ghost = bodyOfShape(reply.ghost);
  if (clock.on) {
    // An equilibrium that was asked for before the clock was is no more to be shown.
    if (reply.id === clock.waiting) clock.receive(reply);
  } else if (reply.motion) {
    // Nor a moving arm after it.
  } else if (reply.error) {
    refused(reply.error);
  } else if (reply.answer) {
    controls.blame(null);
    if (reply.pulled && pulling) takeTensions(reply.pulled.tensions);
    answered(reply);
  }
  const took = performance.now() - asked;
  latencies.push(took);
  if (latencies.length > 1000) latencies.shift();
  sayTook(`${took.toFixed(1)} ms`, `From input to picture; ${(reply.microseconds / 1e3).toFixed(1)} ms of it in the server`);
  if (letGo && connection.asked.size === 0) endPull();
}

/** @param {number[]} tensions */
function takeTensions(tensions) {
  /** @type {Record<string, Setting | undefined>} */
  const values = {};
  tensions.forEach((tension, c) => {
    values[`cable[${c}].tension`] = tension;
    values[`cable[${c}].stroke`] = undefined;
  });
  state.change(values, true);
  controls.refresh();
}

/** @param {Reply} reply */
function answered(reply) {
  const { answer, drawing, pulled } = reply;
  if (!answer) return;
  const words = wordsOf(answer, drawing);
  const shape = answer.converged ? answer : answer.last_good;
  if (pulled && shape) {
    const lines = wordsOfPull(pulled, shape.cables);
    if (lines.length > 0) {
      words.lines.unshift(...lines);
      if (words.level === "good") words.level = "warn";
    }
  }
  say(words);
  if (!shape || !drawing) return;
  present = { shape, drawing, asked: answer.converged };
  view.show({ shape, drawing, body: bodyOf(shape, drawing), asked: answer.converged });
  tabulate(numbersOf(shape));
  along.show(shape, pins);
  controls.learn(shape.inputs);
  legend(shape);
}

/**
 * An arm in motion.
 * @param {{ shape: Solution, drawing: Drawing, motion: import("./types").MotionReply, body: Body }} moving
 */
function moved({ shape, drawing, motion, body }) {
  const asked = motion.ended === undefined;
  present = { shape, drawing, asked };
  view.show({ shape, drawing, body, asked });
  const now = performance.now();
  if (now - movedSaid < READABLE && asked && clock.playing) return;
  movedSaid = now;
  tabulate(numbersOfMotion(shape, motion));
  along.show(shape, pins);
  legend(shape);
}
let movedSaid = -READABLE;

/** Nothing moves any more: the equilibrium again. @param {string} [why] */
function still(why) {
  view.scene.trail = [];
  view.scene.target = undefined;
  if (why) toast(why, "bad");
  connection.send(wish());
}

/** @param {import("./types").Problem} problem */
function refused(problem) {
  say({ level: "bad", title: "The request is refused", lines: [problem.message] });
  controls.blame(problem.key);
  stopRamp?.();
}

/** @param {import("./words.js").Words} words */
function say(words) {
  const box = byId("verdict", HTMLElement);
  const key = JSON.stringify(words);
  if (box.dataset.key === key) return;
  box.dataset.key = key;
  box.dataset.level = words.level;
  byId("verdict-title", HTMLElement).textContent = words.title;
  byId("verdict-lines", HTMLElement).replaceChildren(...words.lines.map((text) => element("li", { text })));
  sayAloud();
}

/** A screen reader reads what the verdict comes to, not all that it is while something moves. */
const sayAloud = settled(700, () => {
  const lines = [...byId("verdict", HTMLElement).querySelectorAll("strong, li")].map((line) => line.textContent);
  byId("said", HTMLElement).textContent = lines.join(" ");
});

/** @param {[string, string][]} rows */
function tabulate(rows) {
  const list = byId("numbers", HTMLElement);
  if (list.children.length !== rows.length) list.replaceChildren(...rows.map(() => element("div", {}, [element("dt"), element("dd")])));
  rows.forEach(([name, value], i) => {
    const [term, text] = list.children[i].children;
    if (term.textContent !== name) term.textContent = name;
    if (text.textContent !== value) text.textContent = value;
  });
}

/** @param {Solution} shape */
function legend(shape) {
  const place = byId("legend", HTMLElement);
  const { speed, direction } = shape.inputs.flow;
  /** @type {[string, string][]} */
  const items = shape.cables.map((cable, c) => [`swatch c${c % 7}${cable.tension > 0 ? "" : " slack"}`, `${cable.name}: ${cable.tension > 0 ? force(cable.tension) : "slack"}`]);
  // What is not drawn has no sample.
  const flows = speed > 0 && (view.scene.layers.stream || view.scene.layers.layer);
  if (flows) items.push(["swatch cflow", `stream ${Number(speed.toPrecision(4))} m/s ${typeof direction === "number" ? `at ${Number(direction.toPrecision(4))}\u00b0` : `along (${directionOf(direction).map((v) => fixed(v, 2)).join(", ")})`}`]);
  if (view.scene.layers.ghost) items.push(["swatch cghost slack", "unloaded"]);
  const key = JSON.stringify(items);
  if (place.dataset.key === key) return;
  place.dataset.key = key;
  place.replaceChildren(...items.map(([kind, text]) => element("span", {}, [element("i", { class: kind }), text])));
}

// --- Pins, layers, tabs, theme -----------------------------------------------------------------------------------------

byId("pin", HTMLButtonElement).addEventListener("click", () => {
  if (!present) return;
  const free = [0, 2, 3, 4].find((colour) => pins.every((pin) => pin.colour !== colour));
  if (free === undefined || pins.length >= PINS) {
    toast(`${PINS} shapes are pinned already; take one off first`, "bad");
    return;
  }
  const { shape, drawing } = present;
  const label = `${shape.inputs.name}: ${shape.cables.map((c) => force(c.tension)).join(", ")}; ${shape.inputs.flow.speed} m/s`;
  pins.push({ shape, body: bodyOf(shape, drawing), colour: free, label });
  showPins();
});

function showPins() {
  byId("pins", HTMLElement).replaceChildren(...pins.map((pin) => {
    const off = element("button", { type: "button", text: "\u00d7", "aria-label": `Remove ${pin.label}` });
    off.addEventListener("click", () => {
      pins = pins.filter((other) => other !== pin);
      showPins();
    });
    return element("span", {}, [element("i", { class: `dot c${pin.colour}` }), pin.label, off]);
  }));
  view.scene.pins = pins;
  view.paint();
  if (present) along.show(present.shape, pins);
}

/** @type {[string, string][]} */
const LAYERS = [
  ["sections", "Section lines"], ["directors", "Directors at the tip"], ["stream", "Stream"], ["gravity", "Gravity"], ["layer", "Boundary layer"],
  ["ghost", "Unloaded arm"], ["trail", "Trail of the tip"], ["contact", "Contact forces"],
];
const tints = element("select", { "aria-label": "Colour of the body" }, [
  element("option", { value: "plain", text: "plain" }), element("option", { value: "alpha", text: "by \u03b1" }),
  element("option", { value: "eta", text: "by shear \u03b7" }), element("option", { value: "nu", text: "by stretch \u03bd" }),
]);
tints.addEventListener("change", () => {
  view.scene.tints = /** @type {import("./paint.js").Scene["tints"]} */ (tints.value);
  view.paint();
});
byId("layers", HTMLElement).append(...LAYERS.map(([name, text]) => {
  const box = element("input", { type: "checkbox", checked: view.scene.layers[name] });
  box.addEventListener("change", () => {
    view.scene.layers[name] = box.checked;
    if (name === "trail") view.scene.trail = [];
    view.paint();
    if (present) legend(present.shape);
  });
  return element("label", {}, [box, text]);
}), element("label", {}, ["Body", tints]));

const tabs = /** @type {HTMLButtonElement[]} */ ([...byId("tabs", HTMLElement).children]);
/** @param {HTMLButtonElement} chosen */
function open(chosen) {
  for (const tab of tabs) {
    const on = tab === chosen;
    tab.setAttribute("aria-selected", String(on));
    tab.tabIndex = on ? 0 : -1;
    byId(tab.getAttribute("aria-controls") ?? "", HTMLElement).hidden = !on;
  }
  if (chosen.id === "tab-readings") studies.compare();
}
for (const [i, tab] of tabs.entries()) {
  tab.addEventListener("click", () => open(tab));
  tab.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step === undefined) return;
    const next = tabs[(i + step + tabs.length) % tabs.length];
    next.focus();
    open(next);
  });
}

const dark = matchMedia("(prefers-color-scheme: dark)");
/** Whether the page is dark: as the user chose, else as the system is. */
const isDark = () => (document.documentElement.dataset.theme ?? (dark.matches ? "dark" : "light")) === "dark";
function recolour() {
  byId("theme", HTMLButtonElement).textContent = isDark() ? "\u2600" : "\u263e";
  view.recolour();
  along.recolour();
  studies.paths.recolour();
  clock.charts.draw();
}
dark.addEventListener("change", recolour);
byId("theme", HTMLButtonElement).addEventListener("click", () => {
  const chosen = isDark() ? "light" : "dark";
  document.documentElement.dataset.theme = chosen;
  kept.set("theme", chosen);
  recolour();
});

// --- The beginning ---------------------------------------------------------------------------------------------------

/** Takes what the address says, or what the program was started with. */
async function begin() {
  recolour();
  tidyMenus();
  listenToHelp();
  listenToShare(state, () => view.image(`${state.arm.name}: ${byId("verdict-title", HTMLElement).textContent}`));
  listenToFiles(state);
  const [{ arms, start, given }, options] = await Promise.all(["/api/arms", "/api/options"].map(async (path) => (await ask(path)).json()));
  controls.options = studies.options = /** @type {Options} */ (options);
  byId("arm", HTMLSelectElement).replaceChildren(...arms.map((/** @type {{ name: string, description: string }} */ { name, description }) =>
    element("option", { value: name, text: name, title: description })));
  if (given) own.set(given.name, given.toml);
  if (await state.fromHash(location.hash).catch(() => false)) return;
  state.choose(given ?? { name: start ?? arms[0].name });
}

window.addEventListener("hashchange", async () => {
  if (location.hash !== `#${await state.toHash()}`) state.fromHash(location.hash);
});

begin().catch((error) => toast(error instanceof Error ? error.message : String(error), "bad"));
