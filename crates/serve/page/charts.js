// Charts along the arm, linked with the drawing, and the tip over a path. Chart.js draws them.

/** @import { Chart as ChartJs, ChartConfiguration, Plugin } from "chart.js" */
/** @import { PathDocument, Solution, Stations } from "./types" */

import { degrees, fixed, forceUnit, number } from "./numbers.js";
import { element } from "./page.js";
import { colours } from "./paint.js";

/** The library comes as a script of its own and is found by its name. @type {typeof ChartJs} */
const Chart = /** @type {any} */ (globalThis).Chart;

/** From one chart to the next, ms: the drawing of the arm goes first, and while the arm moves it gets most of the time. */
const PACE = { moving: 120, still: 15 };
/** So long after the last shape an arm has stopped, ms. */
const STILL = 150;

/**
 * @typedef {{ key: keyof Stations, name: string, unit: (shape: Solution) => [number, string] }} Quantity
 */

/** @type {Quantity[]} */
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

/** What rounding leaves of zero is zero: else a chart of nothing would show it. @param {number} value */
const clean = (value) => (Math.abs(value) < 1e-12 ? 0 : value);

/** @param {number[]} values */
const greatest = (values) => values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);

/** Options that all charts share. */
function look() {
  const colour = colours();
  const grid = { color: colour("line"), drawTicks: false };
  const ticks = { color: colour("quiet"), maxTicksLimit: 6, padding: 5, font: { size: 11 } };
  return { colour, grid, ticks };
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
    /** When the newest and the one before came, ms. */
    this.came = [-STILL, -STILL];
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.timer = undefined;
    this.look = look();
    this.charts = QUANTITIES.map((quantity) => {
      const canvas = element("canvas", { role: "img", "aria-label": `${quantity.name} along the arm` });
      const value = element("output");
      const unit = element("span");
      place.append(element("figure", { class: "chart" }, [
        element("figcaption", {}, [element("span", {}, [quantity.name, " ", unit]), value]),
        element("div", {}, [canvas]),
      ]));
      const chart = new Chart(canvas, this.configuration(onHover));
      return { quantity, chart, canvas, value, unit, stale: false, seen: false };
    });
    // What is out of sight costs no time.
    const watch = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const one = this.charts.find(({ canvas }) => canvas === target);
        if (one) one.seen = isIntersecting;
      }
      this.go();
    });
    for (const { canvas } of this.charts) watch.observe(canvas);
    this.recolour();
  }

  /**
   * @param {(s: number | undefined) => void} onHover
   * @returns {ChartConfiguration<"line", { x: number, y: number }[]>}
   */
  configuration(onHover) {
    /** @type {Plugin<"line">} */
    const mark = {
      id: "mark",
      afterDraw: (chart) => {
        if (this.mark === undefined) return;
        const { ctx, chartArea } = chart;
        const x = chart.scales.x.getPixelForValue(1e3 * this.mark);
        ctx.save();
        ctx.strokeStyle = String(this.look.colour("accent"));
        ctx.beginPath();
        ctx.moveTo(x, chartArea.top);
        ctx.lineTo(x, chartArea.bottom);
        ctx.stroke();
        ctx.restore();
      },
      afterEvent: (_, { event }) => {
        if (event.type === "mouseout") onHover(undefined);
      },
    };
    return {
      type: "line",
      data: { datasets: [] },
      plugins: [mark],
      options: {
        animation: false, parsing: false, normalized: true, maintainAspectRatio: false,
        elements: { point: { radius: 0, hitRadius: 0 }, line: { borderWidth: 1.8, tension: 0 } },
        plugins: { legend: { display: false }, tooltip: { enabled: false } },
        scales: { x: { type: "linear", min: 0, title: { display: true, text: "s (mm)", font: { size: 11 } } }, y: { grace: "4%" } },
        onHover: (event, _, chart) => {
          if (event.x === null) return;
          const s = chart.scales.x.getValueForPixel(event.x);
          onHover(s === undefined ? undefined : s / 1e3);
        },
      },
    };
  }

  /** The theme has changed. */
  recolour() {
    this.look = look();
    const { colour, grid, ticks } = this.look;
    for (const { chart } of this.charts) {
      const { scales } = chart.options;
      if (!scales?.x || !scales.y) continue;
      Object.assign(scales.x, { grid, ticks, border: { color: colour("line") } });
      Object.assign(/** @type {any} */ (scales.x).title, { color: colour("quiet") });
      Object.assign(scales.y, { grid, ticks, border: { display: false } });
      chart.update("none");
    }
    if (this.newest) this.show(this.newest.shape, this.newest.pins);
  }

  /**
   * Shows a shape, one chart after the other.
   * @param {Solution} shape
   * @param {{ shape: Solution, colour: number }[]} pins
   */
  show(shape, pins) {
    this.newest = { shape, pins };
    this.came = [performance.now(), this.came[0]];
    for (const one of this.charts) one.stale = true;
    this.go();
  }

  /** Draws the next of those that are stale and in sight, and comes back for the others. */
  go() {
    if (this.timer !== undefined) return;
    const next = this.charts.find(({ stale, seen }) => stale && seen);
    if (!next) return;
    const moving = performance.now() - this.came[1] < STILL;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      // The next in turn: a moving arm makes all of them stale again before the last is reached.
      this.charts.push(...this.charts.splice(this.charts.indexOf(next), 1));
      next.stale = false;
      this.draw(next);
      this.go();
    }, moving ? PACE.moving : PACE.still);
  }

  /** @param {AlongCharts["charts"][number]} one */
  draw({ quantity, chart, unit }) {
    if (!this.newest) return;
    const { shape, pins } = this.newest;
    const { colour } = this.look;
    const [factor, name] = quantity.unit(shape);
    const line = (/** @type {Solution} */ one, /** @type {string} */ ink, /** @type {number[]} */ dash) => ({
      data: one.stations.s.map((s, i) => ({ x: 1e3 * s, y: clean(factor * one.stations[quantity.key][i]) })),
      borderColor: ink, borderDash: dash,
    });
    unit.textContent = name === "" ? "" : `(${name})`;
    chart.data.datasets = [line(shape, colour("series-1"), []), ...pins.map((pin) => line(pin.shape, colour(`series-${pin.colour}`), [5, 3]))];
    if (chart.options.scales?.x) chart.options.scales.x.max = 1e3 * shape.inputs.arm.length;
    chart.update("none");
    this.values();
  }

  /**
   * Marks a place along the arm in all charts.
   * @param {number | undefined} s
   */
  hover(s) {
    if (s === this.mark) return;
    this.mark = s;
    for (const { chart } of this.charts) chart.draw();
    this.values();
  }

  /** The values at the mark. */
  values() {
    const shape = this.newest?.shape;
    for (const { quantity, value } of this.charts) {
      if (!shape || this.mark === undefined) {
        value.textContent = "";
        continue;
      }
      const { s } = shape.stations;
      const at = Math.min(Math.max(this.mark, 0), s[s.length - 1]);
      const i = Math.max(1, s.findIndex((place) => place >= at));
      const share = (at - s[i - 1]) / Math.max(s[i] - s[i - 1], 1e-12);
      const values = shape.stations[quantity.key];
      const [factor] = quantity.unit(shape);
      value.textContent = number(factor * (values[i - 1] + share * (values[i] - values[i - 1])), 4);
    }
  }
}

/**
 * @typedef {{ value: number, name: string, unit: string, factor: number }} Axis
 */

export class PathCharts {
  /**
   * @param {HTMLElement} place
   * @param {(value: number) => void} onChoose with a value of the parameter in the unit shown
   */
  constructor(place, onChoose) {
    this.charts = ["Tip x (mm)", "Tip y (mm)", "Tip section, \u03b1(L) (\u00b0)"].map((name) => {
      const canvas = element("canvas", { role: "img", "aria-label": `${name} over the path` });
      place.append(element("figure", { class: "chart" }, [element("figcaption", { text: name }), element("div", {}, [canvas])]));
      return new Chart(canvas, {
        type: /** @type {const} */ ("line"),
        data: { datasets: [] },
        options: {
          animation: false, parsing: false, maintainAspectRatio: false,
          interaction: { mode: "nearest", intersect: false },
          elements: { line: { borderWidth: 1.8, tension: 0 } },
          plugins: { legend: { display: false }, tooltip: { displayColors: false, callbacks: { title: () => "" } } },
          scales: { x: { type: "linear", title: { display: true, text: "" } }, y: { grace: "4%" } },
          onClick: (_, points, chart) => {
            const point = points[0];
            if (!point) return;
            const chosen = /** @type {{ x: number }} */ (chart.data.datasets[point.datasetIndex].data[point.index]);
            onChoose(chosen.x);
          },
        },
      });
    });
  }

  /**
   * @param {PathDocument} path
   * @param {string} name of the parameter, with its unit
   * @param {(si: number) => number} shown
   */
  show(path, name, shown) {
    const { colour, grid, ticks } = look();
    this.charts.forEach((chart, c) => {
      const read = [(/** @type {any} */ p) => 1e3 * p.tip.x, (/** @type {any} */ p) => 1e3 * p.tip.y, (/** @type {any} */ p) => degrees(p.tip.alpha)][c];
      chart.data.datasets = path.branches.map((branch, b) => ({
        data: branch.points.map((p) => ({ x: shown(p.value), y: clean(read(p)) })),
        borderColor: colour(`series-${(b + 1) % 7}`),
        pointRadius: branch.points.map((p) => (p.event ? 5 : 1.6)),
        pointBackgroundColor: branch.points.map((p) => (p.event ? colour("series-0") : colour(`series-${(b + 1) % 7}`))),
        pointBorderWidth: 0,
        segment: { borderDash: (/** @type {{ p1DataIndex: number }} */ s) => (branch.points[s.p1DataIndex].stability.state === "stable" ? undefined : [3, 4]) },
      }));
      const { scales } = chart.options;
      if (scales?.x && scales.y) {
        Object.assign(scales.x, { grid, ticks });
        Object.assign(/** @type {any} */ (scales.x).title, { text: name, color: colour("quiet") });
        Object.assign(scales.y, { grid, ticks });
      }
      const tooltip = chart.options.plugins?.tooltip;
      if (tooltip?.callbacks) {
        tooltip.callbacks.label = (item) => {
          const point = path.branches[item.datasetIndex].points[item.dataIndex];
          const words = point.event ? point.event.replaceAll("_", " ") : point.stability.state ?? "stability not established";
          return `${fixed(item.parsed.x, 3)}: ${fixed(item.parsed.y, 3)}, ${words}`;
        };
      }
      chart.update("none");
    });
  }
}
