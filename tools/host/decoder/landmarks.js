// The landmarks of pictures, put together from their parts, with other messages and losses between them.
//
//   const picture = collector.add(message)   // every message that arrives; null unless a picture is complete
//   picture   { frame_seq, captured_us, width_px, height_px, points }: x and y of every landmark in pixels, one after
//             the other; none of them when the picture shows no face
export class LandmarkCollector {
  #first = null; // any part of the picture that is being put together
  #points = new Float32Array(0);
  #missing = 0;

  add(part) {
    if (part.type !== 'landmarks') return null;
    const begun = this.#first;
    if (!begun || part.first === 0 || part.frame_seq !== begun.frame_seq || part.total !== begun.total) this.#begin(part);
    part.eighth_px.forEach((eighths, i) => {
      const at = 2 * part.first + i;
      if (Number.isNaN(this.#points[at])) --this.#missing;
      this.#points[at] = eighths / 8;
    });
    if (this.#missing > 0) return null;
    this.#first = null;
    const { frame_seq, captured_us, width_px, height_px } = part;
    return { frame_seq, captured_us, width_px, height_px, points: this.#points };
  }

  #begin(part) {
    this.#first = part;
    this.#points = new Float32Array(2 * part.total).fill(NaN);
    this.#missing = 2 * part.total;
  }
}
