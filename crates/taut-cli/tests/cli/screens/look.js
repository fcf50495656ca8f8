// What a reader sees of a page, as data: texts that cover each other, are cut off or too faint, and where figures are.
(() => {
  const rgb = (color) => (color.match(/[\d.]+/g) || []).slice(0, 3).map(Number);
  // Relative luminance and contrast of WCAG 2.
  const luminance = (color) => {
    const [r, g, b] = rgb(color).map((c) => { c /= 255; return c <= .03928 ? c / 12.92 : ((c + .055) / 1.055) ** 2.4; });
    return .2126 * r + .7152 * g + .0722 * b;
  };
  const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + .05) / (low + .05);
  };
  const ground = getComputedStyle(document.documentElement).backgroundColor;
  const place = ({ left, top, width, height }) => [left + scrollX, top + scrollY, width, height];

  // The letters of each line: of its box the middle, as lines that are set close have boxes that overlap.
  const lines = [], cut = [], faint = [];
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node; (node = texts.nextNode());) {
    const words = node.data.trim(), element = node.parentElement, style = getComputedStyle(element);
    if (!words || element.closest("script, style, noscript, title, desc") || style.visibility === "hidden") continue;
    const range = document.createRange(), svg = element.closest("svg");
    range.selectNodeContents(node);
    const inside = svg && svg.getBoundingClientRect();
    for (const box of range.getClientRects()) {
      if (!box.width || !box.height) continue;
      const upright = svg && /rotate/.test(element.getAttribute("transform") || "");
      const [dx, dy] = upright ? [.22 * box.width, 0] : [0, .22 * box.height];
      lines.push({ words, left: box.left + dx, right: box.right - dx, top: box.top + dy, bottom: box.bottom - dy });
      if (inside && (box.left < inside.left - 1 || box.right > inside.right + 1 || box.top + dy < inside.top - 1 || box.bottom - dy > inside.bottom + 1)) cut.push(words);
    }
    if (!(contrast(svg ? style.fill : style.color, ground) >= 3)) faint.push(words);
  }
  lines.sort((a, b) => a.top - b.top);
  const covered = [];
  lines.forEach((a, i) => {
    for (let j = i + 1; j < lines.length && lines[j].top < a.bottom - .5; j++) {
      const b = lines[j];
      if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > .5) covered.push(a.words + " | " + b.words);
    }
  });

  const figures = [...document.querySelectorAll("figure")].map((figure) => {
    const sheet = figure.querySelector(".sheet");
    return {
      title: figure.querySelector("h3").textContent,
      place: place(sheet.getBoundingClientRect()),
      whole: sheet.scrollWidth <= sheet.clientWidth,
      alone: figure.parentElement.className === "rest" && figure.parentElement.children.length === 1,
    };
  });
  return { ground: rgb(ground), size: [innerWidth, document.documentElement.scrollHeight], wide: document.documentElement.scrollWidth, lines: lines.length, covered, cut, faint, figures };
})()
