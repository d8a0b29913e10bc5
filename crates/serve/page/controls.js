// The panel of loads, material and readings, made from what the arm has.

/** @import { Choice, Direction, Inputs, Options, Profile } from "./types" */
/** @import { State } from "./state.js" */

import { directionOf } from "./camera.js";
import { number, roundUp } from "./numbers.js";
import { element } from "./page.js";

/** Materials to try, for arms that have a Young's modulus. */
const MATERIALS = [
  { name: "silicone rubber, 110 kPa", values: { "material.young": 110e3, "material.poisson": 0.5, "arm.density": 1080 } },
  { name: "soft silicone, 40 kPa", values: { "material.young": 40e3, "material.poisson": 0.5, "arm.density": 1070 } },
  { name: "octopus muscle, 10 kPa", values: { "material.young": 10e3, "material.poisson": 0.5, "arm.density": 1050 } },
];

/**
 * A number that can be moved; its value is undefined where the file has none. Values are in the units of the arm file; `per` of the unit shown are one of those.
 * @typedef {{ key: string, label: string, unit: string, per: number, min: number, max: number, value: number | undefined, colour?: number }} Range
 */

export class Controls {
  /**
   * @param {HTMLElement} place
   * @param {State} state
   * @param {(key: string, range: Range) => void} onRamp
   */
  constructor(place, state, onRamp) {
    this.place = place;
    this.state = state;
    this.onRamp = onRamp;
    /** @type {Map<string, { range: Range, slider: HTMLInputElement, box: HTMLInputElement, row: HTMLElement }>} */
    this.ranges = new Map();
    /** @type {Map<string, { choice: Choice, select: HTMLSelectElement, label: HTMLElement, own: string, row: HTMLElement }>} */
    this.choices = new Map();
    /** What can be chosen, as the server says. @type {Options} */
    this.options = { readings: [], flow_law: { key: "flow.law", label: "", meaning: "", words: [] } };
    /** @type {Inputs | undefined} */
    this.inputs = undefined;
    /** The largest tension of each cable's slider, N. @type {number[]} */
    this.most = [];
    /** What has to look at the state anew before values are shown. @type {(() => void)[]} */
    this.modes = [];
    /** The present stroke (m) of a cable. @type {(c: number) => number} */
    this.strokeOf = () => 0;
    /** The present tension (N) of a cable. @type {(c: number) => number} */
    this.tensionOf = () => 0;
    /** @type {HTMLSelectElement | undefined} */
    this.preset = undefined;
    /** When the user last moved something: the time of that event. */
    this.moved = 0;
    place.addEventListener("submit", (event) => event.preventDefault());
  }

  /**
   * Makes the panel for an arm.
   * @param {Inputs} inputs of the arm without overrides
   * @param {number[]} scale a tension, N, that each cable alone hardly exceeds
   */
  build(inputs, scale) {
    this.inputs = inputs;
    this.ranges.clear();
    this.choices.clear();
    this.modes = [];
    const cables = inputs.cable ?? [];
    this.most = cables.map((cable, c) => cable.max_tension ?? roundUp(Math.max(0.8 * scale[c], 1.5 * (cable.tension ?? 0))));
    const strongest = Math.max(...this.most, 0) || scale[0] || 1;
    this.place.replaceChildren(
      this.cables(inputs),
      this.group("Stream", [
        this.range({ key: "flow.speed", label: "Speed", unit: "m/s", per: 1, min: 0, max: Math.max(1, roundUp(1.5 * inputs.flow.speed)), value: inputs.flow.speed }),
        ...this.direction(inputs, "flow.direction", inputs.flow.direction),
        this.choice(this.options.flow_law, inputs.flow.law),
        ...this.drag(inputs),
        this.range({ key: "flow.layer_thickness", label: "Boundary layer", unit: "mm", per: 1e3, min: 0.001, max: 0.02, value: inputs.flow.layer_thickness }),
      ]),
      this.group("Gravity", [
        this.range({ key: "gravity.acceleration", label: "Acceleration", unit: "m/s\u00b2", per: 1, min: 0, max: 20, value: inputs.gravity?.acceleration ?? 0 }),
        ...this.direction(inputs, "gravity.direction", inputs.gravity?.direction ?? -90),
      ]),
      this.tipLoads(inputs, strongest),
      this.material(inputs),
      this.group("Base", inputs.arm.base.direction
        ? this.direction(inputs, "arm.base.direction", inputs.arm.base.direction)
        : [this.range({ key: "arm.base.angle", label: "Angle", unit: "\u00b0", per: 1, min: -180, max: 180, value: inputs.arm.base.angle ?? 0 })]),
      this.group("Readings of the source", this.options.readings.map((choice) => this.choice(choice, inputs.model[choice.key.replace("model.", "")]))),
      element("p", {}, [this.button("Reset to the arm file", () => this.state.choose(this.state.arm))]),
    );
    this.refresh();
  }

  /**
   * A direction: its angle in the plane, its parts in space, where only their proportion counts.
   * @param {Inputs} inputs
   * @param {string} key
   * @param {Direction} own
   */
  direction({ arm }, key, own) {
    if (arm.space !== "spatial") {
      return [this.range({ key, label: "Direction", unit: "\u00b0", per: 1, min: -180, max: 180, value: typeof own === "number" ? own : 0 })];
    }
    return directionOf(own).map((part, k) => {
      const value = Number(part.toPrecision(6));
      return this.range({ key: `${key}[${k}]`, label: `Direction along ${"xyz"[k]}`, unit: "", per: 1, min: -1, max: 1, value });
    });
  }

  /** @param {string} text @param {() => void} onClick */
  button(text, onClick) {
    const made = element("button", { type: "button", text });
    made.addEventListener("click", onClick);
    return made;
  }

  /** @param {string} title @param {HTMLElement[]} rows */
  group(title, rows) {
    return element("fieldset", {}, [element("legend", { text: title }), ...rows]);
  }

  /** @param {Inputs} inputs */
  cables(inputs) {
    const rows = (inputs.cable ?? []).map((cable, c) => {
      const place = element("div");
      const build = () => {
        const stroke = this.state.set.has(`cable[${c}].stroke`) || (cable.stroke !== undefined && !this.state.set.has(`cable[${c}].tension`));
        if (place.dataset.mode === String(stroke)) return;
        place.dataset.mode = String(stroke);
        this.ranges.delete(`cable[${c}].stroke`);
        this.ranges.delete(`cable[${c}].tension`);
        place.replaceChildren(this.cable(inputs, c, stroke));
      };
      this.modes.push(build);
      build();
      return place;
    });
    if (rows.length === 0) rows.push(element("p", { class: "quiet", text: "This arm has no cables." }));
    return this.group("Cables", rows);
  }

  /** @param {Inputs} inputs @param {number} c @param {boolean} stroke */
  cable(inputs, c, stroke) {
    const cable = (inputs.cable ?? [])[c];
    const [tensionKey, strokeKey] = [`cable[${c}].tension`, `cable[${c}].stroke`];
    const length = inputs.arm.length;
    const most = this.most[c];
    const milli = most < 0.2;
    /** @type {Range} */
    const range = stroke
      ? { key: strokeKey, label: cable.name, unit: "mm", per: 1e3, min: -0.25 * length, max: 0.25 * length, value: cable.stroke ?? 0, colour: c % 7 }
      : { key: tensionKey, label: cable.name, unit: milli ? "mN" : "N", per: milli ? 1e3 : 1, min: 0, max: most, value: cable.tension ?? 0, colour: c % 7 };
    const mode = element("select", { "aria-label": `Control of cable ${cable.name}` }, [
      element("option", { value: "tension", text: "tension" }), element("option", { value: "stroke", text: "stroke" }),
    ]);
    mode.value = stroke ? "stroke" : "tension";
    mode.addEventListener("change", () => {
      if (mode.value === "stroke") this.state.change({ [tensionKey]: undefined, [strokeKey]: this.strokeOf(c) });
      else this.state.change({ [strokeKey]: undefined, [tensionKey]: this.tensionOf(c) });
    });
    const ramp = element("button", { type: "button", text: "\u25b6", "aria-label": `Raise ${cable.name} from zero and watch`, title: "Raise from zero and watch" });
    ramp.addEventListener("click", () => this.onRamp(range.key, range));
    return this.range(range, [mode, ramp]);
  }

  /** @param {Inputs} inputs @param {number} strongest */
  tipLoads(inputs, strongest) {
    const force = roundUp(0.03 * strongest);
    const [unit, per] = force < 0.2 ? ["mN", 1e3] : ["N", 1];
    const moment = roundUp(0.3 * force * inputs.arm.length);
    const forces = inputs.tip.force.map((value, k) =>
      this.range({ key: `tip.force[${k}]`, label: `Force along ${"xyz"[k]}`, unit, per, min: -force, max: force, value }));
    const about = (/** @type {string} */ key, /** @type {string} */ label, /** @type {number} */ value) =>
      this.range({ key, label, unit: "N mm", per: 1e3, min: -moment, max: moment, value });
    const own = inputs.tip.moment;
    const moments = typeof own === "number" ? [about("tip.moment", "Moment", own)]
      : own.map((value, k) => about(`tip.moment[${k}]`, `Moment about ${"xyz"[k]}`, value));
    return this.group("Load on the tip", [...forces, ...moments]);
  }

  /** @param {Inputs} inputs */
  material(inputs) {
    const rows = [];
    const { material } = inputs;
    const scalar = (/** @type {Profile | undefined} */ value) => (typeof value === "number" ? value : undefined);
    const young = scalar(material.young);
    if (young !== undefined) {
      const select = element("select", { id: "material-preset" }, [element("option", { value: "", text: "as in the file" }), ...MATERIALS.map(({ name }) => element("option", { value: name, text: name }))]);
      select.addEventListener("change", () => {
        const chosen = MATERIALS.find(({ name }) => name === select.value);
        this.state.change(chosen?.values ?? { "material.young": undefined, "material.poisson": undefined, "arm.density": undefined });
      });
      this.preset = select;
      rows.push(element("div", { class: "control choice" }, [element("label", { for: "material-preset", text: "Preset" }), select]));
      rows.push(this.range({ key: "material.young", label: "Young\u2019s modulus", unit: "kPa", per: 1e-3, min: Math.min(1e3, 0.2 * young), max: roundUp(3 * young), value: young }));
      rows.push(this.range({ key: "material.poisson", label: "Poisson\u2019s ratio", unit: "", per: 1, min: 0, max: 0.5, value: scalar(material.poisson) ?? 0.5 }));
    } else {
      this.preset = undefined;
      const labels = /** @type {const} */ ([["c1", "C1, stretch", "kPa", 1e-3], ["c2", "C2, shear", "kPa", 1e-3], ["c3", "C3, bending", "N", 1], ["c4", "C4, twist", "N", 1]]);
      for (const [name, label, unit, per] of labels) {
        const value = scalar(material[name]);
        if (value !== undefined) rows.push(this.range({ key: `material.${name}`, label, unit, per, min: 0.2 * value, max: roundUp(3 * value), value }));
      }
    }
    rows.push(this.range({ key: "arm.density", label: "Density", unit: "kg/m\u00b3", per: 1, min: 500, max: 2000, value: inputs.arm.density }));
    return this.group("Material", rows);
  }

  /**
   * The coefficients of quadratic drag, shown with that law. They have no default, here as on the command line.
   * @param {Inputs} inputs
   */
  drag(inputs) {
    const { cn, ct } = inputs.flow;
    const rows = [
      this.range({ key: "flow.cn", label: "Normal drag C\u2099", unit: "", per: 1, min: 0, max: Math.max(5, roundUp(2 * (cn ?? 0))), value: cn }),
      this.range({ key: "flow.ct", label: "Tangential drag C\u209c", unit: "", per: 1, min: 0, max: Math.max(0.05, roundUp(2 * (ct ?? 0))), value: ct }),
    ];
    const show = () => {
      const law = this.state.set.get("flow.law") ?? inputs.flow.law;
      for (const row of rows) row.hidden = law !== "quadratic-drag";
    };
    this.modes.push(show);
    return rows;
  }

  /**
   * A slider with a box for the exact number.
   * @param {Range} range
   * @param {HTMLElement[]} [more]
   */
  range(range, more = []) {
    const { key, label, unit, per, min, max, colour } = range;
    const id = `control-${key.replaceAll(/[^a-z0-9]/g, "-")}`;
    const slider = element("input", { type: "range", id, min: String(min), max: String(max), step: "any", "data-key": key });
    const box = element("input", { type: "number", step: "any", "data-box": key, "aria-label": `${label}${unit ? `, ${unit}` : ""}` });
    const named = unit === "" ? label : `${label} (${unit})`;
    const row = element("div", { class: "control" }, [
      element("span", { class: "name" }, [
        ...(colour === undefined ? [] : [element("span", { class: `dot c${colour}` })]), element("label", { for: id, text: named }), ...more,
      ]),
      slider, box,
    ]);
    slider.addEventListener("input", (event) => {
      this.moved = event.timeStamp;
      // A slider is not finer than a thousandth of its range: no more digits than that.
      this.state.change({ [key]: Number(Number(slider.value).toPrecision(4)) });
    });
    box.addEventListener("change", (event) => {
      this.moved = event.timeStamp;
      const value = box.valueAsNumber;
      if (Number.isFinite(value)) this.state.change({ [key]: value / per });
      else this.refresh();
    });
    this.ranges.set(key, { range, slider, box, row });
    return row;
  }

  /**
   * @param {Choice} choice
   * @param {string} own the word of the file
   */
  choice(choice, own) {
    const { key, meaning, words } = choice;
    const id = `control-${key.replaceAll(/[^a-z0-9]/g, "-")}`;
    const select = element("select", { id, "data-key": key }, words.map(({ word, meaning: title }) => element("option", { value: word, text: word, title })));
    select.addEventListener("change", (event) => {
      this.moved = event.timeStamp;
      this.state.change({ [key]: select.value === own ? undefined : select.value });
    });
    const label = element("label", { for: id, text: choice.label, title: meaning });
    const row = element("div", { class: "control choice" }, [label, select]);
    this.choices.set(key, { choice, select, label, own, row });
    return row;
  }

  /**
   * Takes the coefficients of quadratic drag from a shape that has them: the arm's file may give them beside another law.
   * @param {Inputs} inputs
   */
  learn(inputs) {
    for (const name of /** @type {const} */ (["cn", "ct"])) {
      const key = `flow.${name}`;
      const [shown, value] = [this.ranges.get(key), inputs.flow[name]];
      if (shown === undefined || shown.range.value !== undefined || value === undefined || this.state.set.has(key)) continue;
      shown.range.value = value;
      shown.slider.max = String(Math.max(Number(shown.slider.max), roundUp(2 * value)));
      this.refresh();
    }
  }

  /** Shows the values of the state. */
  refresh() {
    for (const mode of this.modes) mode();
    for (const [key, { range, slider, box, row }] of this.ranges) {
      const set = this.state.set.get(key);
      const value = typeof set === "number" ? set : range.value;
      if (value === undefined) {
        [slider.value, box.value, box.placeholder] = [String(range.min), "", "needed"];
        slider.setAttribute("aria-valuetext", "not given");
        continue;
      }
      if (Number(slider.value) !== value) slider.value = String(value);
      const shown = String(Number((value * range.per).toPrecision(6)));
      // What stays costs no time.
      if (document.activeElement !== box && box.value !== shown) box.value = shown;
      const spoken = `${number(value * range.per, 4)} ${range.unit}`;
      if (slider.getAttribute("aria-valuetext") !== spoken) slider.setAttribute("aria-valuetext", spoken);
      row.classList.toggle("moved", set !== undefined);
    }
    for (const [key, { choice, select, label, own, row }] of this.choices) {
      const chosen = String(this.state.set.get(key) ?? own);
      if (select.value !== chosen) select.value = chosen;
      const word = choice.words.find((one) => one.word === chosen);
      const says = `${choice.meaning}. ${chosen}: ${word?.meaning ?? ""}`;
      if (label.title !== says) {
        label.title = select.title = says;
        select.setAttribute("aria-description", says);
      }
      row.classList.toggle("moved", this.state.set.has(key));
    }
    if (this.preset) {
      const young = this.state.set.get("material.young");
      this.preset.value = MATERIALS.find(({ values }) => values["material.young"] === young)?.name ?? "";
    }
  }

  /**
   * Marks the control whose value the server refuses.
   * @param {string | null} key
   */
  blame(key) {
    const mark = (/** @type {HTMLElement} */ row, /** @type {HTMLElement[]} */ fields, /** @type {boolean} */ wrong) => {
      if (row.classList.contains("wrong") === wrong) return;
      row.classList.toggle("wrong", wrong);
      for (const field of fields) {
        if (wrong) {
          field.setAttribute("aria-invalid", "true");
          field.setAttribute("aria-errormessage", "verdict-lines");
        } else {
          field.removeAttribute("aria-invalid");
          field.removeAttribute("aria-errormessage");
        }
      }
    };
    for (const [own, { row, slider, box }] of this.ranges) mark(row, [slider, box], own === key);
    for (const [own, { row, select }] of this.choices) mark(row, [select], own === key);
  }

  /** What can be traced: loads and material, with the range of their sliders. */
  tracks() {
    return [...this.ranges.values()].map(({ range }) => range).filter(({ key }) => !/layer_thickness|material\.c\d|flow\.c/.test(key));
  }
}
