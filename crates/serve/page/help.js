// The dialog that says what can be done.

import { byId } from "./page.js";

export function listenToHelp() {
  const dialog = byId("help-dialog", HTMLDialogElement);
  byId("help", HTMLButtonElement).addEventListener("click", () => dialog.showModal());
  byId("help-close", HTMLButtonElement).addEventListener("click", () => dialog.close());
  // A click beside it closes it.
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
}
