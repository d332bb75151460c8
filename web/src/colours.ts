// Perceptually uniform colour maps of matplotlib (CC0), sampled evenly; linear in between.
const STOPS: Record<string, string> = {
  inferno: "0000040403120b0724150b37210c4a2f0a5b3d09654a0c6b57106e64156e71196e7d1e6d8a226a972766a32c61b0315bbc3754c73e4cd24644db503be45a31eb6628f1731df68013f98e09fb9d07fcac11fbbc21f9cb35f5db4cf2ea69f3f68afcffa4",
  viridis: "44015448186a472d7b4240863b528b33638d2c728e26828e21918c1fa08828ae803fbc735ec96284d44baddc30d8e219fde725",
  coolwarm: "3b4cc0445acc4e68d85875e16282ea6c8ff1779af782a6fb8db0fe98b9ffa3c2feaec9fcb9d0f9c3d5f4ccd9edd5dbe5dddcdce5d8d1ecd3c5f1ccb8f5c4acf7ba9ff7b093f6a586f4987af08b6eeb7d62e46e56dd5f4bd44e41ca3b37be242eb40426",
};

export type Rgb = [number, number, number];

/** 256 colours of a map, as bytes r, g, b, 255. */
export function colourTable(name: string): Uint8ClampedArray {
  const hex = STOPS[name], last = hex.length / 6 - 1;
  const table = new Uint8ClampedArray(256 * 4);
  for (let i = 0; i < 256; i++) {
    const place = (i / 255) * last, stop = Math.min(Math.floor(place), last - 1), share = place - stop;
    for (let c = 0; c < 3; c++) {
      const from = parseInt(hex.substr(stop * 6 + c * 2, 2), 16), to = parseInt(hex.substr((stop + 1) * 6 + c * 2, 2), 16);
      table[i * 4 + c] = from + (to - from) * share;
    }
    table[i * 4 + 3] = 255;
  }
  return table;
}

const TOWARDS: Rgb = [0.07, 0.32, 0.92], STILL: Rgb = [0.42, 0.45, 0.5], AWAY: Rgb = [0.86, 0.12, 0.1];

/** Colour of a radial velocity, in 0..1: blue towards the radar, grey at rest, red away; seen before light and dark. */
export function velocityColour(velocity: number, top: number): Rgb {
  const share = Math.min(1, Math.abs(velocity) / top) || 0, end = velocity < 0 ? TOWARDS : AWAY;
  return STILL.map((still, c) => still + (end[c] - still) * share) as Rgb;
}
