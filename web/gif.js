"use strict";
// A film as a GIF: colours of the whole film in one palette, and of each picture what has changed.

// the colours that most of these pictures (RGBA) have, at most 255, as 0xrrggbb; the one behind them is transparent
function paletteOf(pictures) {
  const count = new Map();
  for (const picture of pictures) {
    for (let i = 0; i < picture.length; i += 4) {
      const colour = (picture[i] << 16) | (picture[i + 1] << 8) | picture[i + 2];
      count.set(colour, (count.get(colour) || 0) + 1);
    }
  }
  return [...count].sort((a, b) => b[1] - a[1] || a[0] - b[0]).slice(0, 255).map(([colour]) => colour);
}

// what gives the index of the nearest colour of a palette
function nearestIn(palette) {
  const known = new Map(palette.map((colour, i) => [colour, i]));
  const apart = (a, b) => [16, 8, 0].reduce((sum, bits) => sum + (((a >> bits) & 255) - ((b >> bits) & 255)) ** 2, 0);
  return (colour) => {
    let found = known.get(colour);
    if (found === undefined) {
      found = 0;
      for (let i = 1; i < palette.length; i++) if (apart(palette[i], colour) < apart(palette[found], colour)) found = i;
      known.set(colour, found);
    }
    return found;
  };
}

// indices of eight bits by the GIF's own variant of LZW, in blocks of up to 255 bytes
function packedIndices(indices) {
  const [CLEAR, END] = [256, 257];
  const bytes = [];
  let [held, bits] = [0, 0];
  const put = (code, size) => {
    held |= code << bits;
    for (bits += size; bits >= 8; bits -= 8) {
      bytes.push(held & 255);
      held >>>= 8;
    }
  };
  const table = new Map(); // of a code and what follows it
  let [size, next] = [9, END + 1];
  put(CLEAR, size);
  let code = indices[0];
  for (let i = 1; i < indices.length; i++) {
    const key = (code << 8) | indices[i];
    const longer = table.get(key);
    if (longer !== undefined) {
      code = longer;
      continue;
    }
    put(code, size);
    if (next < 4096) {
      table.set(key, next);
      if (next++ === 1 << size) size += 1;
    } else {
      put(CLEAR, size);
      table.clear();
      [size, next] = [9, END + 1];
    }
    code = indices[i];
  }
  put(code, size);
  put(END, size);
  if (bits) bytes.push(held & 255);
  const blocks = [8]; // bits of an index
  for (let i = 0; i < bytes.length; i += 255) blocks.push(Math.min(255, bytes.length - i), ...bytes.slice(i, i + 255));
  return Uint8Array.from([...blocks, 0]);
}

// A GIF of a size, endless. Each picture (RGBA) that `add` is given stands for so many hundredths of a second.
class Gif {
  constructor(width, height, palette, hundredths) {
    Object.assign(this, { width, height, hundredths, nearest: nearestIn(palette), clear: palette.length, last: null });
    const colours = Array.from({ length: 256 }, (_, i) => palette[i] || 0).flatMap((colour) => [colour >> 16, (colour >> 8) & 255, colour & 255]);
    const loop = [0x21, 0xff, 11, ...this.letters("NETSCAPE2.0"), 3, 1, 0, 0, 0];
    this.parts = [Uint8Array.from([...this.letters("GIF89a"), ...this.word(width), ...this.word(height), 0xf7, 0, 0, ...colours, ...loop])];
  }

  letters(text) {
    return [...text].map((letter) => letter.charCodeAt(0));
  }

  word(value) {
    return [value & 255, value >> 8];
  }

  add(picture) {
    const indices = new Uint8Array(this.width * this.height);
    for (let i = 0; i < indices.length; i++) indices[i] = this.nearest((picture[4 * i] << 16) | (picture[4 * i + 1] << 8) | picture[4 * i + 2]);
    const changed = this.last ? indices.map((index, i) => (index === this.last[i] ? this.clear : index)) : indices;
    this.last = indices;
    const control = [0x21, 0xf9, 4, 0x05, ...this.word(this.hundredths), this.clear, 0]; // it stays, and one colour is clear
    const place = [0x2c, 0, 0, 0, 0, ...this.word(this.width), ...this.word(this.height), 0];
    this.parts.push(Uint8Array.from([...control, ...place]), packedIndices(changed));
  }

  get size() {
    return this.parts.reduce((sum, part) => sum + part.length, 1);
  }

  bytes() {
    const whole = new Uint8Array(this.size);
    let at = 0;
    for (const part of [...this.parts, [0x3b]]) {
      whole.set(part, at);
      at += part.length;
    }
    return whole;
  }
}
