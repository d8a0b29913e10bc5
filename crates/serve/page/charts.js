// Charts along the arm, linked with the drawing, and the tip over a path.

/** @import { PathDocument, Point, Solution, State, Stations } from "./types" */

import { Chart } from "./chart.js";
import { degrees, fixed, forceUnit, number } from "./numbers.js";
import { element } from "./page.js";
import { colours } from "./paint.js";

/**
 * @typedef {{ key: keyof Stations, name: string, unit: (shape: Solution) => [number, string] }} Quantity
 */

/** Those of an arm in the plane. @type {Quantity[]} */
const QUANTITIES = [
  { key: "alpha", name: "\u03b1, centreline against section", unit: () => [degrees(1), "\u00b0"] },
  { key: "nu", name: "\u03bd, stretch", unit: () => [1, ""] },
  { key: "eta", name: "\u03b7, shear", unit: () => [1, ""] },
  { key: "mu", name: "\u03bc, bending", unit: () => [1, "1/m"] },
  { key: "beta", name: "\u03b2, section stretch", unit: () => [1, ""] },
  { key: "n_a", name: "N, axial contact force", unit: (shape) => forceUnit(greatest(shape.stations.n_a)) },
  { key: "n_b", name: "H, shear contact force", unit: (shape) => forceUnit(greatest(shape.stations.n_b)) },
  { key: "m", name: "M, contact moment", unit: () => [1e3, "N mm"] },
];

/** Those of an arm in space. @type {Quantity[]} */
const IN_SPACE = [
  ...QUANTITIES.slice(0, 2),
  { key: "eta", name: "\u03b7, shear along b", unit: () => [1, ""] },
  { key: "zeta", name: "\u03b6, shear along c", unit: () => [1, ""] },
  { key: "tau", name: "\u03c4, twist", unit: () => [1, "1/m"] },
  { key: "kappa", name: "\u03ba, bending about b", unit: () => [1, "1/m"] },
  { key: "mu", name: "\u03bc, bending about c", unit: () => [1, "1/m"] },
  QUANTITIES[4], QUANTITIES[5],
  { key: "n_b", name: "Contact force along b", unit: (shape) => forceUnit(greatest(shape.stations.n_b)) },
  { key: "n_c", name: "Contact force along c", unit: (shape) => forceUnit(greatest(shape.stations.n_c ?? [])) },
  { key: "m_a", name: "Contact torque, about a", unit: () => [1e3, "N mm"] },
  { key: "m_b", name: "Contact moment about b", unit: () => [1e3, "N mm"] },
  { key: "m_c", name: "Contact moment about c", unit: () => [1e3, "N mm"] },
];

/** A quantity along the arm, where it has it. @param {Solution} shape @param {keyof Stations} key @returns {number[] | undefined} */
const along = ({ stations }, key) => /** @type {number[] | undefined} */ (stations[key]);

/** What rounding leaves of zero is zero: else a chart of nothing would show it. @param {number} value */
const clean = (value) => (Math.abs(value) < 1e-12 ? 0 : value);

/** @param {number[]} values */
const greatest = (values) => values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);

/** The present colours. */
function look() {
  const colour = colours();
  const [ink, quiet, line, card, accent] = ["ink", "quiet", "line", "card", "accent"].map(colour);
  return { colour, chart: { ink, quiet, line, card, accent } };
}

export class AlongCharts {
  /**
   * @param {HTMLElement} place
   * @param {(s: number | undefined) => void} onHover with a place along the arm, m
   */
  constructor(place, onHover) {
    /** Where the mark stands, m. @type {number | undefined} */
    this.mark = undefined;
    /** The newest shape, with those to compare it with. @type {{ shape: Solution, pins: { shape: Solution, colour: number }[] } | undefined} */
    this.newest = undefined;
    this.due = false;
    this.look = look();
    this.place = place;
    this.onHover = onHover;
    // What is out of sight costs no time.
    this.watch = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const one = this.charts.find(({ canvas }) => canvas === target);
        if (one) one.seen = isIntersecting;
      }
      this.go();
    });
    this.quantities = QUANTITIES;
    this.charts = this.made();
    this.recolour();
  }

  /** Charts of the present quantities. */
  made() {
    this.watch.disconnect();
    this.place.replaceChildren();
    const { place, onHover } = this;
    const charts = this.quantities.map((quantity) => {
      const canvas = element("canvas", { role: "img", "aria-label": `${quantity.name} along the arm` });
      const value = element("span", { class: "value" });
      const unit = element("span");
      const frame = element("div", {}, [canvas]);
      const figure = element("figure", { class: "chart" }, [element("figcaption", {}, [element("span", {}, [quantity.name, " ", unit]), value]), frame]);
      place.append(figure);
      const chart = new Chart(frame, canvas);
      chart.across = { title: "s (mm)", least: 0, most: undefined };
      canvas.addEventListener("pointermove", (event) => onHover(chart.valueAt(event) / 1e3));
      canvas.addEventListener("pointerdown", (event) => onHover(chart.valueAt(event) / 1e3));
      canvas.addEventListener("pointerleave", () => onHover(undefined));
      return { quantity, chart, canvas, figure, value, unit, stale: false, seen: false };
    });
    for (const { canvas } of charts) this.watch.observe(canvas);
    return charts;
  }

  /** The theme has changed. */
  recolour() {
    this.look = look();
    for (const one of this.charts) {
      one.chart.look = this.look.chart;
      one.stale = true;
    }
    this.go();
  }

  /**
   * Shows a shape.
   * @param {Solution} shape
   * @param {{ shape: Solution, colour: number }[]} pins
   */
  show(shape, pins) {
    this.newest = { shape, pins };
    const quantities = shape.stations.z ? IN_SPACE : QUANTITIES;
    if (quantities !== this.quantities) {
      this.quantities = quantities;
      this.charts = this.made();
      this.recolour();
    }
    for (const one of this.charts) {
      one.stale = true;
      // Of a moving arm no forces are known.
      one.figure.hidden = (along(shape, one.quantity.key) ?? []).length === 0;
    }
    this.go();
  }

  /** Draws what is stale and in sight with the next frame. */
  go() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      for (const one of this.charts.filter(({ stale, seen }) => stale && seen)) this.draw(one);
    });
  }

  /** @param {AlongCharts["charts"][number]} one */
  draw(one) {
    if (!this.newest) return;
    const { quantity, chart, canvas, unit } = one;
    const { shape, pins } = this.newest;
    const { colour } = this.look;
    const [factor, name] = quantity.unit(shape);
    const points = (/** @type {Solution} */ own) =>
      (along(own, quantity.key) ?? []).map((value, i) => /** @type {Point} */ ([1e3 * own.stations.s[i], clean(factor * value)]));
    const caption = name === "" ? "" : `(${name})`;
    if (unit.textContent !== caption) unit.textContent = caption;
    chart.across.most = 1e3 * shape.inputs.arm.length;
    chart.show([
      { points: points(shape), colour: colour("series-1") },
      ...pins.map((pin) => ({ points: points(pin.shape), colour: colour(`series-${pin.colour}`), dash: [5, 3] })),
    ]);
    one.stale = false;
    canvas.setAttribute("aria-label", `${quantity.name} along the arm: ${chart.words(name)}`);
    this.value(one);
  }

  /**
   * Marks a place along the arm in all charts.
   * @param {number | undefined} s
   */
  hover(s) {
    if (s === this.mark) return;
    this.mark = s;
    for (const one of this.charts) {
      one.chart.mark = s === undefined ? undefined : 1e3 * s;
      if (one.seen) one.chart.draw();
      this.value(one);
    }
  }

  /** The value at the mark. @param {AlongCharts["charts"][number]} one */
  value({ quantity, value }) {
    const shape = this.newest?.shape;
    if (!shape || this.mark === undefined) {
      if (value.textContent !== "") value.textContent = "";
      return;
    }
    const { s } = shape.stations;
    const at = Math.min(Math.max(this.mark, 0), s[s.length - 1]);
    const i = Math.max(1, s.findIndex((place) => place >= at));
    const share = (at - s[i - 1]) / Math.max(s[i] - s[i - 1], 1e-12);
    const values = along(shape, quantity.key);
    if (!values) return;
    const [factor] = quantity.unit(shape);
    value.textContent = number(factor * (values[i - 1] + share * (values[i] - values[i - 1])), 4);
  }
}

/** What is drawn of a path. @type {{ name: string, unit: string, of: (state: State) => number }[]} */
const OVER = [
  { name: "Tip x (mm)", unit: "mm", of: ({ tip }) => 1e3 * tip.x },
  { name: "Tip y (mm)", unit: "mm", of: ({ tip }) => 1e3 * tip.y },
  { name: "Tip z (mm)", unit: "mm", of: ({ tip }) => 1e3 * (tip.z ?? 0) },
  { name: "Tip section, \u03b1(L) (\u00b0)", unit: "\u00b0", of: ({ tip }) => degrees(tip.alpha) },
];

export class PathCharts {
  /**
   * @param {HTMLElement} place
   * @param {(value: number) => void} onChoose with a value of the parameter in the unit shown
   */
  constructor(place, onChoose) {
    /** @type {{ path: PathDocument, name: string, shown: (si: number) => number } | undefined} */
    this.newest = undefined;
    this.charts = OVER.map(({ name, unit, of }) => {
      const canvas = element("canvas", { role: "img", "aria-label": `${name} over the path` });
      const frame = element("div", {}, [canvas]);
      place.append(element("figure", { class: "chart" }, [element("figcaption", { text: name }), frame]));
      const chart = new Chart(frame, canvas);
      canvas.addEventListener("pointermove", (event) => {
        chart.chosen = chart.nearestTo(event);
        canvas.style.cursor = chart.chosen ? "pointer" : "";
        chart.draw();
      });
      canvas.addEventListener("pointerleave", () => {
        chart.chosen = undefined;
        chart.draw();
      });
      canvas.addEventListener("click", (event) => {
        const near = chart.nearestTo(event);
        if (near) onChoose(chart.lines[near.line].points[near.k][0]);
      });
      return { chart, canvas, name, unit, of, figure: frame.parentElement };
    });
  }

  /** The theme has changed. */
  recolour() {
    if (this.newest) this.show(this.newest.path, this.newest.name, this.newest.shown);
  }

  /**
   * @param {PathDocument} path
   * @param {string} name of the parameter, with its unit
   * @param {(si: number) => number} shown
   */
  show(path, name, shown) {
    this.newest = { path, name, shown };
    const { colour, chart: own } = look();
    const inSpace = path.branches.some(({ points }) => points.some(({ tip }) => tip.z !== undefined));
    for (const { chart, canvas, name: quantity, unit, of, figure } of this.charts) {
      if (figure && quantity === "Tip z (mm)") figure.hidden = !inSpace;
      chart.look = own;
      chart.across = { title: name, least: undefined, most: undefined };
      chart.show(path.branches.map(({ points }, b) => {
        const ink = colour(`series-${(b + 1) % 7}`);
        return {
          points: points.map((p) => /** @type {Point} */ ([shown(p.value), clean(of(p))])),
          colour: ink,
          broken: (/** @type {number} */ k) => points[k + 1].stability.state !== "stable",
          spots: (/** @type {number} */ k) => (points[k].event ? { radius: 5, colour: colour("series-0") } : { radius: 1.6, colour: ink }),
          words: (/** @type {number} */ k) => {
            const { event, stability, value } = points[k];
            const what = event ? event.replaceAll("_", " ") : stability.state ?? "stability not established";
            return `${fixed(shown(value), 3)}: ${fixed(of(points[k]), 3)}, ${what}`;
          },
        };
      }));
      canvas.setAttribute("aria-label", `${quantity} over ${name}: ${chart.words(unit)}`);
    }
  }
}
