/** The names of the columns of a table; a pair adds the meaning of a column, and a name that is false is left out. */
export function TableHead({
  names,
}: {
  names: readonly (string | false | readonly [name: string, meaning: string])[];
}) {
  return (
    <thead>
      <tr>
        {names.map((one) => {
          if (one === false) return null;
          const [name, meaning] = typeof one === "string" ? [one] : one;
          return name ? (
            <th key={name} scope="col" title={meaning}>
              {name}
            </th>
          ) : (
            <td key={name} />
          );
        })}
      </tr>
    </thead>
  );
}
