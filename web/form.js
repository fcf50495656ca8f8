// The form of a tool's options, made from what the module says of them.

/** Makes an element with attributes and children. */
export function make(name, attributes = {}, ...children) {
  const element = Object.assign(document.createElement(name), attributes);
  element.append(...children);
  return element;
}

function choice(option) {
  const select = make("select");
  select.append(...option.choices.map(({ name, help }) => make("option", { value: name, title: help }, name)));
  const words = make("p", { className: "quiet" });
  const show = () => {
    words.textContent = option.choices.find(({ name }) => name === select.value)?.help ?? "";
  };
  select.addEventListener("change", show);
  select.show = show;
  return [select, words];
}

function field(option) {
  const id = `option-${option.name}`;
  if (option.kind === "flag") {
    const box = make("input", { type: "checkbox", id, name: option.name });
    return make("div", { className: "option flag" }, make("label", {}, box, make("span", {}, option.help)));
  }
  const label = make("label", { htmlFor: id, title: option.help }, `${option.name}: ${option.help}`);
  if (option.kind === "choice") {
    const [select, words] = choice(option);
    Object.assign(select, { id, name: option.name });
    return make("div", { className: "option" }, label, select, words);
  }
  const input = make("input", { id, name: option.name, inputMode: "decimal", placeholder: String(option.usual) });
  return make("div", { className: "option" }, label, input);
}

/** Fills `place` with the options of a tool, set to `given`. */
export function show(place, tool, given) {
  place.replaceChildren(...tool.options.map(field));
  for (const option of tool.options) {
    const element = place.querySelector(`[name="${option.name}"]`);
    const value = given[option.name];
    if (option.kind === "flag") element.checked = value === "true";
    else if (option.kind === "choice" && option.choices.some(({ name }) => name === value)) element.value = value;
    else if (option.kind !== "choice" && value !== undefined) element.value = value;
    element.show?.();
  }
}

/** Returns the options that differ from the usual ones, as text. */
export function given(place, tool) {
  const options = {};
  for (const option of tool.options) {
    const element = place.querySelector(`[name="${option.name}"]`);
    if (option.kind === "flag") {
      if (element.checked) options[option.name] = "true";
    } else if (option.kind === "choice") {
      if (element.value !== option.choices[0].name) options[option.name] = element.value;
    } else if (element.value.trim() !== "") {
      options[option.name] = element.value.trim();
    }
  }
  return options;
}

/** The same options as the module takes them. */
export function asked(tool, options) {
  const kind = (name) => tool.options.find((option) => option.name === name)?.kind;
  const known = Object.entries(options).filter(([name]) => kind(name));
  return JSON.stringify(Object.fromEntries(known.map(([name, value]) => [name, kind(name) === "flag" ? value === "true" : value])));
}
