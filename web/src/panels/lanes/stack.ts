/** Upper edges of probabilities stacked on one another, column by column; together they fill the height. */
export function stack(layers: readonly Float32Array[]): Float32Array[] {
  const columns = layers[0]?.length ?? 0;
  const edges = layers.map(() => new Float32Array(columns));
  for (let c = 0; c < columns; c += 1) {
    let total = 0;
    for (const layer of layers) total += layer[c];
    let sum = 0;
    layers.forEach((layer, i) => {
      sum += layer[c] / total;
      edges[i][c] = sum;
    });
  }
  return edges;
}
