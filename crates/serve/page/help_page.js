// The tables of the guide to the viewer: what can be chosen, as the server says.

/** @import { Choice, Options } from "./types" */

import { ask } from "./connection.js";
import { byId, element } from "./page.js";

/** @param {Choice[]} choices */
function table(choices) {
  const rows = choices.flatMap(({ label, meaning, words }) => [
    element("tr", {}, [element("th", { scope: "rowgroup", colspan: "2", text: `${label}: ${meaning}` })]),
    ...words.map(({ word, meaning: what }) => element("tr", {}, [element("td", { text: word }), element("td", { text: what })])),
  ]);
  return element("table", {}, [element("tbody", {}, rows)]);
}

/** @type {Options} */
const { readings, flow_law: law } = await (await ask("/api/options")).json();
byId("law", HTMLElement).append(table([law]));
byId("readings", HTMLElement).append(table(readings));
