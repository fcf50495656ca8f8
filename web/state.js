// The state of the page in its address, so that a link shows the same: #tool=ball&points=clouds&epsilon=0.

/** Reads { tool, points, options } from the address. */
export function read() {
  const words = new URLSearchParams(location.hash.slice(1));
  const { tool, points, ...options } = Object.fromEntries(words);
  return { tool, points, options };
}

/** Writes it. Points of a file are not in the address; its other parts are. */
export function write({ tool, points, options }) {
  const words = new URLSearchParams({ tool, ...(points ? { points } : {}) });
  for (const [name, value] of Object.entries(options)) words.set(name, value);
  history.replaceState(null, "", `#${words}`);
}
