// Sets what the user chose, dark or light, before anything is painted. Without a choice the style sheet follows the system.
"use strict";

try {
  const chosen = localStorage.getItem("theme");
  if (chosen === "dark" || chosen === "light") document.documentElement.dataset.theme = chosen;
} catch {
  // A browser that keeps nothing has no choice of before.
}
