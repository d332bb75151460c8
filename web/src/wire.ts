// The bytes of mmweaver.viz.body_in_photo: a JSON header, then little-endian arrays.

export type Data = Uint8Array | Int16Array | Int32Array | Float32Array;
/** `stride` is the number of frames that are kept of each person, where it is not the shape's. */
export interface Tensor { data: Data; shape: number[]; stride?: number }
export interface Packed { header: any; arrays: Record<string, Tensor> }

const TYPES: Record<string, any> = { u1: Uint8Array, i2: Int16Array, i4: Int32Array, f4: Float32Array };

export function unpack(buffer: ArrayBuffer): Packed {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays: Record<string, Tensor> = {};
  for (const [name, [kind, shape, offset]] of Object.entries<any>(header.arrays)) {
    const count = shape.reduce((a: number, b: number) => a * b, 1);
    arrays[name] = { data: new TYPES[kind](buffer, 4 + length + offset, count), shape };
  }
  return { header, arrays };
}
