import { Button } from "@mantine/core";
import { Component, type ReactNode } from "react";
import { EmptyState } from "./empty-state";

interface ErrorFenceProps {
  name: string;
  children: ReactNode;
}

/** Keeps a panel's failure inside the panel. */
export class ErrorFence extends Component<ErrorFenceProps, { error: Error | undefined }> {
  override state: { error: Error | undefined } = { error: undefined };

  static getDerivedStateFromError(error: Error) {
    return { error };
  }

  override componentDidCatch(error: Error) {
    console.error(`${this.props.name} failed`, error);
  }

  override render() {
    if (!this.state.error) return this.props.children;
    const retry = (
      <Button size="xs" onClick={() => this.setState({ error: undefined })}>
        Show it again
      </Button>
    );
    return (
      <EmptyState title={`${this.props.name} could not be shown`} action={retry}>
        {this.state.error.message}. The bench runs on.
      </EmptyState>
    );
  }
}
