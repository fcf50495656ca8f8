// The share of pixels of each place of a screenshot that are not those of the ground, and the color of its last corner.
async (png, scale, ground, places) => {
  const image = new Image();
  image.src = "data:image/png;base64," + png;
  await image.decode();
  const sheet = new OffscreenCanvas(image.width, image.height), pen = sheet.getContext("2d", { willReadFrequently: true });
  pen.drawImage(image, 0, 0);
  const share = ([left, top, width, height]) => {
    const [w, h] = [width, height].map((side) => Math.max(1, Math.floor(side * scale)));
    const { data } = pen.getImageData(Math.round(left * scale), Math.round(top * scale), w, h);
    let drawn = 0;
    for (let i = 0; i < data.length; i += 4) drawn += [0, 1, 2].some((k) => Math.abs(data[i + k] - ground[k]) > 24);
    return drawn / (w * h);
  };
  // The last pixels may be of what is beside the page.
  const corner = pen.getImageData(image.width - 3, image.height - 3, 1, 1).data;
  return { shares: places.map(share), corner: [...corner.slice(0, 3)] };
}
