// The answer of the solver in words.

/** @import { Answer, CableState, Drawing, MotionReply, Pulled, Solution } from "./types" */

import { fixed, force, forceUnit, number } from "./numbers.js";

/**
 * @typedef {{ level: "good" | "warn" | "bad", title: string, lines: string[] }} Words
 */

/**
 * Of an answer.
 * @param {Answer} answer
 * @param {Drawing} [drawing]
 * @returns {Words}
 */
export function wordsOf(answer, drawing) {
  if (!answer.converged) {
    const { verdict, last_good: shape } = answer;
    const lines = [sentence(verdict.message), `Try: ${verdict.advice}.`];
    const snap = verdict.snaps.at(-1);
    if (snap && verdict.after_snap) {
      lines.push(`At that load the tip would jump by ${fixed(1e3 * snap.distance, 1)} mm and turn by ${fixed((180 / Math.PI) * snap.angle, 1)} deg.`);
    }
    if (shape) {
      lines.push("The picture shows the last good shape before this limit, not the requested loads.");
      lines.push(...shape.warnings.map((note) => sentence(note.message)));
    }
    return { level: "bad", title: `No equilibrium at these loads: ${kindWords(verdict.kind)}`, lines };
  }
  const lines = answer.warnings.map((note) => sentence(note.message));
  if (answer.unmet) {
    lines.push(`The balance at the tip is not met: a force of ${vector(answer.unmet.force, (f) => number(f, 4))} N and a moment of ${vector(answer.unmet.moment, (m) => number(m, 4))} N m remain.`);
  }
  const { title, level } = stabilityOf(answer);
  if (drawing?.crossing) {
    lines.unshift(`The arm passes through itself near x = ${fixed(1e3 * drawing.crossing[0], 0)} mm, y = ${fixed(1e3 * drawing.crossing[1], 0)} mm. The model knows no contact: a real arm does not take this shape.`);
    return { level: "warn", title: `${title}, but the arm passes through itself`, lines };
  }
  if (lines.length > 0) return { level: level === "good" ? "warn" : level, title: `${title}, with ${kindsOf(answer)}`, lines };
  return { level, title, lines };
}

/** A kind for people. What folds is the surface; `cable_fold` is something else. @param {string} kind */
const kindWords = (kind) => (kind === "cable_fold" ? "side compressed to zero length" : kind.replaceAll("_", " "));

/** One number, or several in brackets. @param {number | number[]} value @param {(v: number) => string} text */
const vector = (value, text) => (typeof value === "number" ? text(value) : `(${value.map(text).join(", ")})`);

/** @param {Solution} answer */
function kindsOf(answer) {
  const kinds = [...answer.warnings.map(({ kind }) => kind.replaceAll("_", " ")), ...(answer.unmet ? ["unmet balance of the tip"] : [])];
  return `${kinds.length === 1 ? "a warning" : "warnings"}: ${kinds.join(", ")}`;
}

/**
 * @param {Solution} answer
 * @returns {{ title: string, level: "good" | "warn" }}
 */
function stabilityOf(answer) {
  if (answer.stable === true) return { title: "In equilibrium, stable", level: "good" };
  if (answer.stable === false) return { title: "In equilibrium, but unstable: the arm would leave this shape at the slightest push", level: "warn" };
  return { title: "In equilibrium; stability is not established", level: "warn" };
}

/**
 * What pulling the tip came to; empty where it went where it was pulled.
 * @param {Pulled} pulled
 * @param {CableState[]} cables
 */
export function wordsOfPull(pulled, cables) {
  const lines = [];
  if (!pulled.reached) {
    const bounds = pulled.bounds.map(({ cable, kind }) => {
      const { name, tension } = cables[cable] ?? { name: String(cable), tension: 0 };
      return kind === "slack" ? `cable ${name} is slack` : `cable ${name} is at its largest tension (${force(tension)})`;
    });
    const why = bounds.length > 0 ? `: ${bounds.join(", ")}` : ": pulling further does not bring it closer";
    lines.push(`The tip cannot go there; it is ${fixed(1e3 * pulled.distance, 1)} mm away${why}.`);
  }
  if (pulled.elsewhere) lines.push("A solve from the unloaded arm at these tensions gives another shape than this drag. The picture shows the shape of the solve.");
  else if (pulled.jumped) lines.push("On the way, the arm jumped to another branch of equilibria.");
  return lines;
}

/**
 * The names and values beside the picture of a moving arm.
 * @param {Solution} shape
 * @param {MotionReply} motion
 * @returns {[string, string][]}
 */
export function numbersOfMotion({ tip, cables, error_estimate: error }, { velocity, kinetic_energy: kinetic, strain_energy: strain, hand }) {
  const energy = (/** @type {number} */ joule) => (Math.abs(joule) < 1e-12 ? "0 \u00b5J" : Math.abs(joule) < 1e-3 ? `${number(1e6 * joule, 3)} \u00b5J` : `${number(1e3 * joule, 3)} mJ`);
  /** @type {[string, string][]} */
  const rows = [["Tip x", `${fixed(1e3 * tip.x, 2)} mm`], ["Tip y", `${fixed(1e3 * tip.y, 2)} mm`]];
  if (tip.z !== undefined) rows.push(["Tip z", `${fixed(1e3 * tip.z, 2)} mm`]);
  rows.push(["Speed of the tip", `${fixed(1e3 * Math.hypot(...velocity), 1)} mm/s`], ["Kinetic energy", energy(kinetic)], ["Energy of strain", energy(strain)]);
  rows.push(["Hand", hand ? force(Math.hypot(...hand)) : "\u2013"]);
  for (const cable of cables) rows.push([`Tension, ${cable.name}`, force(cable.tension)], [`Stroke, ${cable.name}`, `${fixed(1e3 * cable.stroke, 2)} mm`]);
  rows.push(["Tip error, at most about", `${number(1e3 * error, 2)} mm`]);
  return rows;
}

/** @param {string} text */
function sentence(text) {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? "" : "."}`;
}

/**
 * What else is said of the tip: its angle in the plane, its height and directors in space.
 * @param {Solution["tip"]} tip
 * @param {(rad: number) => string} degree
 * @returns {[string, string][]}
 */
function place({ theta, z, a, b, c }, degree) {
  if (z === undefined || !a || !b || !c) return [["Tip turned by", degree(theta ?? 0)]];
  const director = (/** @type {number[]} */ v) => `(${v.map((part) => fixed(part, 3)).join(", ")})`;
  return [["Tip z", `${fixed(1e3 * z, 3)} mm`], ["Tip normal a", director(a)], ["Tip director b", director(b)], ["Tip director c", director(c)]];
}

/**
 * The names and values beside the picture.
 * @param {Solution} shape
 * @returns {[string, string][]}
 */
export function numbersOf(shape) {
  const { tip, base, cables } = shape;
  // What rounding leaves of nothing is nothing.
  const clean = (/** @type {number} */ value) => number(Math.abs(value) < 1e-10 ? 0 : value, 3);
  const [factor, unit] = forceUnit(Math.hypot(...base.force));
  const degree = (/** @type {number} */ rad) => `${fixed((rad * 180) / Math.PI, 3)}\u00b0`;
  /** @type {[string, string][]} */
  const rows = [
    ["Tip x", `${fixed(1e3 * tip.x, 3)} mm`],
    ["Tip y", `${fixed(1e3 * tip.y, 3)} mm`],
    ...place(tip, degree),
    ["Tip section, \u03b1(L)", degree(tip.alpha)],
  ];
  for (const cable of cables) {
    const slack = cable.command?.slack ? " (slack)" : "";
    rows.push([`Tension, ${cable.name}`, `${force(cable.tension)}${slack}`], [`Stroke, ${cable.name}`, `${fixed(1e3 * cable.stroke, 2)} mm`]);
  }
  rows.push(
    ["Base force", `${vector(base.force, (f) => clean(factor * f))} ${unit}`],
    ["Base moment", `${vector(base.moment, (m) => clean(1e3 * m))} N mm`],
    ["Fold margin", number(shape.fold_margin, 3)],
    ["Tip error, about", `${(1e6 * shape.error_estimate).toExponential(1).replace("-", "\u2212")} \u00b5m`],
  );
  return rows;
}
