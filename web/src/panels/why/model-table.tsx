import type { Account } from "../../api/types";
import { formatNumber, formatPercent, formatSi } from "../../ui/format";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { useScheme } from "../../ui/use-scheme";
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
  const axes =
    account.residuals.length > 1 &&
    ` along ${account.residuals.map((name) => name.replace("residual_", "")).join(", ")}`;
  return (
    <div className={styles.scroll}>
      <table className={styles.table}>
        <thead>
          <tr>
            <th scope="col">Hypothesis</th>
            <th scope="col">Residual{axes}</th>
            <th scope="col">√ covariance{axes}</th>
            <th scope="col">ln f</th>
            <th scope="col">Prior</th>
            <th scope="col">Posterior</th>
          </tr>
        </thead>
        <tbody>
          {account.models.map((model, i) => (
            <tr key={model.name} data-chosen={i === chosen} data-best={i === best}>
              <th scope="row">
                <button type="button" aria-pressed={i === chosen} onClick={() => onChoose(i)}>
                  <i style={{ background: traceColour(hypothesisStyle(i), scheme) }} />
                  {model.name}
                </button>
              </th>
              <td>{lengths(model.residual_um)}</td>
              <td>
                {model.covariance_um2 === null ? "–" : lengths(model.covariance_um2.map((row, j) => Math.sqrt(row[j])))}
              </td>
              <td>{model.log_likelihood === null ? "–" : formatNumber(model.log_likelihood, 2)}</td>
              <td>{formatPercent(model.prior, 2)}</td>
              <td>
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
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** Lengths below each other, one for each displacement measured. */
const lengths = (values: number[]) =>
  // biome-ignore lint/suspicious/noArrayIndexKey: a value is known by its displacement, which is its place
  values.map((value, i) => <div key={i}>{formatSi(value, "um", 3)}</div>);
