// Lines over one quantity, on a canvas: axes with round ticks, a mark that moves, and points that can be chosen.

/** @import { Point } from "./types" */

import { plain, ticks } from "./numbers.js";

/**
 * A line through points; NaN parts it. `broken` says which part from a point to the next is dotted, `spots` which points are dots.
 * @typedef {{
 *   points: Point[], colour: string, dash?: number[], broken?: (k: number) => boolean,
 *   spots?: (k: number) => { radius: number, colour: string }, words?: (k: number) => string,
 * }} Line
 */

/**
 * The colours of everything but lines.
 * @typedef {{ ink: string, quiet: string, line: string, card: string, accent: string }} Look
 */

const FONT = '11px system-ui, "Noto Sans", "Liberation Sans", sans-serif';
/** Room for the labels of the axes, px: left, below with its title, right and above. */
const ROOM = { left: 8, below: 30, right: 8, above: 6 };
/** How far, px, the pointer may be from a point to choose it. */
const NEAR = 40;

export class Chart {
  /**
   * @param {HTMLElement} place
   * @param {HTMLCanvasElement} canvas inside of it
   */
  constructor(place, canvas) {
    this.canvas = canvas;
    const ctx = canvas.getContext("2d");
    if (!ctx) throw new Error("the browser has no canvas");
    this.ctx = ctx;
    /** @type {Line[]} */
    this.lines = [];
    this.across = { title: "", least: /** @type {number | undefined} */ (undefined), most: /** @type {number | undefined} */ (undefined) };
    /** @type {Look} */
    this.look = { ink: "", quiet: "", line: "", card: "", accent: "" };
    /** Where the mark stands, on the axis across. @type {number | undefined} */
    this.mark = undefined;
    /** The point that the pointer is near. @type {{ line: number, k: number } | undefined} */
    this.chosen = undefined;
    this.frame = { left: 0, top: 0, right: 1, bottom: 1 };
    this.x = [0, 1];
    this.y = [0, 1];
    new ResizeObserver(() => this.resize()).observe(place);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(width * ratio));
    this.canvas.height = Math.max(1, Math.round(height * ratio));
    this.ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.draw();
  }

  /** @param {Line[]} lines */
  show(lines) {
    this.lines = lines;
    this.chosen = undefined;
    this.canvas.dataset.lines = String(lines.length);
    const all = lines.flatMap(({ points }) => points).filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    const { least, most } = this.across;
    this.x = padded(all.map(([x]) => x), 0, least, most);
    this.y = padded(all.map(([, y]) => y), 0.06);
    this.draw();
  }

  /** What is shown, in words: for those who cannot see it. @param {string} unit */
  words(unit) {
    const values = (this.lines[0]?.points ?? []).map(([, y]) => y).filter(Number.isFinite);
    if (values.length === 0) return "nothing yet";
    const from = values.reduce((a, b) => Math.min(a, b));
    const to = values.reduce((a, b) => Math.max(a, b));
    return `from ${plain(from)} to ${plain(to)}${unit === "" ? "" : ` ${unit}`}`;
  }

  /** @param {Point} point @returns {Point} */
  at([x, y]) {
    const { left, right, top, bottom } = this.frame;
    return [
      left + ((right - left) * (x - this.x[0])) / (this.x[1] - this.x[0]),
      bottom - ((bottom - top) * (y - this.y[0])) / (this.y[1] - this.y[0]),
    ];
  }

  /** The value across at a place of the page. @param {PointerEvent | MouseEvent} event */
  valueAt(event) {
    const { left, right } = this.frame;
    const px = event.clientX - this.canvas.getBoundingClientRect().left;
    const share = Math.min(Math.max((px - left) / (right - left), 0), 1);
    return this.x[0] + share * (this.x[1] - this.x[0]);
  }

  /** The point nearest to the pointer. @param {PointerEvent | MouseEvent} event */
  nearestTo(event) {
    const box = this.canvas.getBoundingClientRect();
    let best = /** @type {{ line: number, k: number } | undefined} */ (undefined);
    let least = NEAR;
    this.lines.forEach(({ points }, line) => points.forEach((point, k) => {
      const [x, y] = this.at(point);
      const away = Math.hypot(x - event.clientX + box.left, y - event.clientY + box.top);
      if (away < least) [least, best] = [away, { line, k }];
    }));
    return best;
  }

  draw() {
    const { ctx, canvas } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width < 20 || height < 20) return;
    ctx.clearRect(0, 0, width, height);
    ctx.font = FONT;
    const up = ticks(this.y[0], this.y[1], Math.max(2, height / 42));
    const widest = Math.max(...up.map(({ label }) => ctx.measureText(label).width), 10);
    this.frame = { left: ROOM.left + widest, top: ROOM.above, right: width - ROOM.right, bottom: height - ROOM.below };
    this.axes(up, ticks(this.x[0], this.x[1], Math.max(2, width / 70)));
    ctx.lineJoin = "round";
    for (const line of this.lines) this.line(line);
    if (this.mark !== undefined) this.upright(this.mark);
    if (this.chosen) this.said(this.chosen);
  }

  /**
   * @param {{ value: number, label: string }[]} up
   * @param {{ value: number, label: string }[]} across
   */
  axes(up, across) {
    const { ctx, frame, look } = this;
    [ctx.strokeStyle, ctx.fillStyle, ctx.lineWidth] = [look.line, look.quiet, 1];
    ctx.beginPath();
    ctx.textBaseline = "middle";
    ctx.textAlign = "right";
    for (const { value, label } of up) {
      const [, y] = this.at([this.x[0], value]);
      ctx.moveTo(frame.left, Math.round(y) + 0.5);
      ctx.lineTo(frame.right, Math.round(y) + 0.5);
      ctx.fillText(label, frame.left - 5, y);
    }
    ctx.textAlign = "center";
    for (const { value, label } of across) {
      const [x] = this.at([value, this.y[0]]);
      ctx.moveTo(Math.round(x) + 0.5, frame.top);
      ctx.lineTo(Math.round(x) + 0.5, frame.bottom);
      const half = 0.5 * ctx.measureText(label).width;
      ctx.fillText(label, Math.min(x, this.canvas.clientWidth - half - 1), frame.bottom + 9);
    }
    ctx.stroke();
    ctx.fillText(this.across.title, 0.5 * (frame.left + frame.right), frame.bottom + 22);
  }

  /** @param {Line} line */
  line({ points, colour, dash = [], broken, spots }) {
    const { ctx } = this;
    [ctx.strokeStyle, ctx.lineWidth] = [colour, 1.8];
    for (const part of broken ? [false, true] : [false]) {
      ctx.setLineDash(part ? [3, 4] : dash);
      ctx.beginPath();
      for (let k = 1; k < points.length; k += 1) {
        if ((broken?.(k - 1) ?? false) !== part) continue;
        const [from, to] = [this.at(points[k - 1]), this.at(points[k])];
        if (![...from, ...to].every(Number.isFinite)) continue;
        ctx.moveTo(...from);
        ctx.lineTo(...to);
      }
      ctx.stroke();
    }
    ctx.setLineDash([]);
    if (!spots) return;
    points.forEach((point, k) => {
      const { radius, colour: fill } = spots(k);
      ctx.fillStyle = fill;
      ctx.beginPath();
      ctx.arc(...this.at(point), radius, 0, 2 * Math.PI);
      ctx.fill();
    });
  }

  /** The mark. @param {number} value */
  upright(value) {
    const { ctx, frame, look } = this;
    const [x] = this.at([value, 0]);
    [ctx.strokeStyle, ctx.lineWidth] = [look.accent, 1];
    ctx.beginPath();
    ctx.moveTo(x, frame.top);
    ctx.lineTo(x, frame.bottom);
    ctx.stroke();
  }

  /** What there is to say of a point, beside it. @param {{ line: number, k: number }} point */
  said({ line, k }) {
    const { ctx, frame, look } = this;
    const own = this.lines[line];
    const [x, y] = this.at(own.points[k]);
    [ctx.strokeStyle, ctx.lineWidth] = [look.ink, 1.5];
    ctx.beginPath();
    ctx.arc(x, y, 6, 0, 2 * Math.PI);
    ctx.stroke();
    const text = own.words?.(k) ?? "";
    const half = 0.5 * ctx.measureText(text).width + 6;
    const middle = Math.min(Math.max(x, frame.left + half), frame.right - half);
    const top = y > frame.top + 30 ? y - 27 : y + 10;
    ctx.fillStyle = look.card;
    ctx.strokeStyle = look.line;
    ctx.fillRect(middle - half, top, 2 * half, 18);
    ctx.strokeRect(middle - half, top, 2 * half, 18);
    [ctx.fillStyle, ctx.textAlign, ctx.textBaseline] = [look.ink, "center", "middle"];
    ctx.fillText(text, middle, top + 9);
  }
}

/**
 * A range round values with some room, never an empty one; its ends where they are given.
 * @param {number[]} values
 * @param {number} share
 * @param {number} [least]
 * @param {number} [most]
 * @returns {Point}
 */
function padded(values, share, least, most) {
  if (values.length === 0) return [least ?? 0, most ?? 1];
  const from = least ?? values.reduce((a, b) => Math.min(a, b));
  const to = most ?? values.reduce((a, b) => Math.max(a, b));
  const size = Math.max(Math.abs(from), Math.abs(to)) || 1;
  const pad = to - from < 1e-6 * size ? 0.1 * size : share * (to - from);
  return [least ?? from - pad, most ?? to + pad];
}
