import { Box, ColorSwatch } from "@mantine/core";
import type { Account } from "../../api/types";
import { formatNumber, formatPercent, formatSi } from "../../ui/format";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { useScheme } from "../../ui/use-canvas";
import styles from "./why.module.css";

interface ModelTableProps {
  account: Account;
  chosen: number;
  onChoose(index: number): void;
}

/** Every hypothesis at this sample; one of them is chosen for the equations. */
export function ModelTable({ account, chosen, onChoose }: ModelTableProps) {
  const scheme = useScheme();
  const best = account.models.reduce((top, m, i, all) => (m.posterior > all[top].posterior ? i : top), 0);
  const filtered = account.gain_units.length > 0;
  const axes =
    account.residuals.length > 1 &&
    ` along ${account.residuals.map((name) => name.replace("residual_", "")).join(", ")}`;
  return (
    <div style={{ overflowX: "auto" }}>
      <table className={styles.table}>
        <thead>
          <tr>
            <th scope="col">Hypothesis</th>
            <th scope="col">Posterior</th>
            <th scope="col">Misses by</th>
            {filtered && (
              <th scope="col" data-detail>
                Gain K{axes}
              </th>
            )}
            <th scope="col">Residual{axes}</th>
            <th scope="col" data-detail>
              √ covariance{axes}
            </th>
            <th scope="col" data-detail>
              ln f
            </th>
            <th scope="col">Prior</th>
          </tr>
        </thead>
        <tbody>
          {account.models.map((model, i) => (
            <tr key={model.name} data-chosen={i === chosen}>
              <th scope="row">
                <button type="button" aria-pressed={i === chosen} onClick={() => onChoose(i)}>
                  <ColorSwatch
                    size={10}
                    radius={2}
                    withShadow={false}
                    color={traceColour(hypothesisStyle(i), scheme)}
                  />
                  {model.name}
                </button>
              </th>
              <Box component="td" fw={i === best ? 700 : undefined}>
                <span
                  className={styles.share}
                  style={
                    {
                      "--share": `${100 * model.posterior}%`,
                      "--colour": traceColour(hypothesisStyle(i), scheme),
                    } as React.CSSProperties
                  }
                >
                  {formatPercent(model.posterior, 2)}
                </span>
              </Box>
              <td>{formatNumber(model.missed_sigma, 1)} σ</td>
              {filtered && <td data-detail>{lines(gains(account, i))}</td>}
              <td>{lines(model.residual_um.map((value) => formatSi(value, "um", 3)))}</td>
              <td data-detail>
                {model.covariance_um2 === null
                  ? "–"
                  : lines(model.covariance_um2.map((row, j) => formatSi(Math.sqrt(row[j]), "um", 3)))}
              </td>
              <td data-detail>{model.log_likelihood === null ? "–" : formatNumber(model.log_likelihood, 2)}</td>
              <td>{formatPercent(model.prior, 2)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** Values below each other, one for each displacement measured. */
const lines = (values: string[]) =>
  // biome-ignore lint/suspicious/noArrayIndexKey: a value is known by its displacement, which is its place
  values.map((value, i) => <div key={i}>{value}</div>);

/** The gain of a model: all of it for one displacement; for several, the gain of each residual for its displacement. */
const gains = ({ models, residuals, gain_units }: Account, index: number): string[] => {
  const { gain } = models[index];
  return residuals.length === 1
    ? gain.map(([k], i) => formatSi(k, gain_units[i], 4))
    : residuals.map((_, i) => formatSi(gain[i][i], gain_units[i], 4));
};
