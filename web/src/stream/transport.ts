/** Events of a channel. The first one comes after the transport has returned the channel. */
export interface ChannelEvents {
  onOpen(): void;
  onMessage(data: ArrayBuffer | string): void;
  /** With a close code of WebSockets, whatever the channel is made of. */
  onClose(code: number): void;
}

/** A way to one bench and back, for as long as it holds. */
export interface Channel {
  readonly isOpen: boolean;
  send(text: string): void;
  /** No message comes any more. */
  close(): void;
}

/** Opens a channel to a bench, by the bench's id. */
export type Transport = (bench: string, events: ChannelEvents) => Channel;
