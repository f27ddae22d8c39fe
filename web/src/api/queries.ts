import { keepPreviousData, QueryClient, useQuery } from "@tanstack/react-query";
import { useCallback, useEffect, useState } from "react";
import { ApiError, type Rows } from "./client";
import { usePanelVisible } from "./panel-visible";

/** The questions to the server and their answers; equal questions share one answer. */
export const queryClient = new QueryClient({
  defaultOptions: {
    queries: {
      retry: false, // a refusal is final; repeated questions have their own interval
      networkMode: "always", // the server may be this machine
      throwOnError: (error) => !(error instanceof ApiError),
    },
  },
});

/** A question by its parts; undefined asks nothing. */
type Question = readonly unknown[] | undefined;

export interface Answer<T> {
  value: T | undefined;
  /** Why the newest question got no answer; the value is an older one then. */
  error: ApiError | undefined;
  /** When `value` came. */
  since: Date | undefined;
  /** Ask now. */
  again(): void;
}

/**
 * Asks the server a question, and again every so often, while the panel around is in sight. A hidden panel keeps its last
 * answer and asks once it is shown.
 *
 * @param every Milliseconds until it is asked again, given the answer; undefined: not again.
 */
export function useAnswer<T>(
  question: Question,
  ask: () => Promise<T>,
  every: (value: T | undefined) => number | undefined = () => undefined,
): Answer<T> {
  const isSeen = usePanelVisible();
  const { data, error, dataUpdatedAt, refetch } = useQuery({
    queryKey: question ?? [],
    queryFn: ask,
    enabled: question !== undefined && isSeen,
    refetchInterval: ({ state }) => every(state.data) ?? false,
  });
  return {
    value: data,
    error: refusal(error),
    since: dataUpdatedAt ? new Date(dataUpdatedAt) : undefined,
    again: useCallback(() => void refetch(), [refetch]),
  };
}

/** Rows of a long list that come at once. */
const SOME = 200;

/** A list that may be long: its first rows, and more on request. */
export function useList<T>(
  question: readonly unknown[],
  ask: (most: number) => Promise<Rows<T>>,
  every: (rows: T[] | undefined) => number | undefined,
): Answer<T[]> & { more: (() => void) | undefined } {
  const [most, setMost] = useState(SOME);
  const { value, ...answer } = useAnswer(
    [...question, most],
    () => ask(most),
    (list) => every(list?.rows),
  );
  const list = useLast(value);
  return { ...answer, value: list?.rows, more: list?.isWhole === false ? () => setMost(most + SOME) : undefined };
}

interface Asked<T> {
  answer: T | undefined;
  refusal: ApiError | undefined;
  /** The answer shown is to the question before. */
  waiting: boolean;
}

/** The server's answer to a question that changes and is asked once; the last answer stays until the next has come. */
export function useAsked<T>(question: Question, ask: () => Promise<T>): Asked<T> {
  const { data, error, isFetching, isPlaceholderData } = useQuery({
    queryKey: question ?? [],
    queryFn: ask,
    enabled: question !== undefined,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 0, // asked again later, a bench may have gone back in time
    placeholderData: keepPreviousData,
  });
  const last = useLast(isPlaceholderData ? undefined : data);
  return { answer: data ?? last, refusal: refusal(error), waiting: isFetching };
}

/** The last answer, while the one to another question of the same kind is under way. */
export function useLast<T>(value: T | undefined): T | undefined {
  const [last, keep] = useState(value);
  useEffect(() => {
    if (value !== undefined) keep(value);
  }, [value]);
  return value ?? last;
}

const refusal = (error: Error | null): ApiError | undefined => (error instanceof ApiError ? error : undefined);
