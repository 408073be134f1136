// SPDX-License-Identifier: BSD-3-Clause
// The hemispheres as a picture that says what it shows.

export interface Tile {
  name: string;
  limit: string;
  /** In parts of its size, from the left and from the top. */
  source: [number, number];
  detector: [number, number];
}

const [margin, line, size] = [12, 22, 15];

/** Sixteen tiles under lines of words. */
export async function pictureOf(canvas: HTMLCanvasElement, tiles: Tile[], words: string[]): Promise<Blob> {
  const whole = document.createElement("canvas");
  const top = margin + line * words.length;
  whole.width = canvas.width + 2 * margin;
  whole.height = canvas.height + top + margin;
  const context = whole.getContext("2d")!;
  context.fillStyle = "#fff";
  context.fillRect(0, 0, whole.width, whole.height);
  context.drawImage(canvas, margin, top);
  context.fillStyle = "#1b1f24";
  context.font = `${size}px system-ui, sans-serif`;
  words.forEach((text, i) => context.fillText(text, margin, margin + line * i + size, canvas.width));
  const side = canvas.width / 4;
  tiles.forEach((tile, e) => {
    const [x, y] = [margin + side * (e % 4), top + side * (e >> 2)];
    context.textAlign = "left";
    context.font = `bold ${size}px system-ui, sans-serif`;
    context.fillText(tile.name, x + 3, y + size);
    context.textAlign = "right";
    context.font = `${size - 3}px system-ui, sans-serif`;
    context.fillText(tile.limit, x + side - 3, y + side - 4);
    mark(context, x + side * tile.source[0], y + side * tile.source[1], "#ffd400");
    mark(context, x + side * tile.detector[0], y + side * tile.detector[1]);
  });
  return new Promise((done, failed) =>
    whole.toBlob((blob) => (blob ? done(blob) : failed(new Error("no picture"))), "image/png"),
  );
}

/** The light is filled, the direction seen from is a ring. */
function mark(context: CanvasRenderingContext2D, x: number, y: number, filled = "") {
  context.save();
  context.beginPath();
  context.arc(x, y, 5.5, 0, 2 * Math.PI);
  if (filled) {
    context.fillStyle = filled;
    context.fill();
  }
  for (const [width, color] of [[4, filled ? "#fff" : "#000"], [2, filled ? "#000" : "#fff"]] as const) {
    context.lineWidth = width;
    context.strokeStyle = color;
    context.stroke();
  }
  context.restore();
}
