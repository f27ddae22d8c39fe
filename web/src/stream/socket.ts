import { sessionProtocols } from "../api/session";
import type { Channel, ChannelEvents } from "./transport";
import { SUBPROTOCOL } from "./wire";

const NORMAL = 1000;

/** Opens a WebSocket to a bench of the server. */
export function openSocket(bench: string, { onOpen, onMessage, onClose }: ChannelEvents): Channel {
  const url = new URL(`./api/v1/benches/${encodeURIComponent(bench)}/stream`, document.baseURI);
  const socket = new WebSocket(url.href.replace(/^http/, "ws"), [SUBPROTOCOL, ...sessionProtocols()]);
  socket.binaryType = "arraybuffer";
  socket.onopen = onOpen;
  socket.onmessage = (event) => onMessage(event.data as ArrayBuffer | string);
  socket.onclose = (event) => onClose(event.code);
  return {
    get isOpen() {
      return socket.readyState === WebSocket.OPEN;
    },
    send: (text) => socket.send(text),
    close: () => socket.close(NORMAL),
  };
}
