import type { Channel, ChannelEvents, Transport } from "../stream/transport";
import type { FromWorker, Port, ToWorker } from "./messages";

const API = /^.*\/api\/v1(?=\/)/;

/** A worker in place of the server: the transport of streams, and what answers a request. */
export function openFolder(port: Port): { transport: Transport; reach: (request: Request) => Promise<Response> } {
  const asked = new Map<number, (answer: Response) => void>();
  const channels = new Map<number, ChannelEvents & { isOpen: boolean }>();
  let count = 0;
  port.onmessage = ({ data }) => take(data);

  function take(message: FromWorker): void {
    if ("ask" in message) {
      const { ask, status, body } = message;
      asked.get(ask)?.(status === 204 ? new Response(null, { status }) : Response.json(body, { status }));
      asked.delete(ask);
      return;
    }
    const channel = channels.get(message.channel);
    if (!channel) return;
    if ("opened" in message) {
      channel.isOpen = true;
      channel.onOpen();
    } else if ("data" in message) {
      channel.onMessage(message.data);
    } else {
      channel.isOpen = false;
      channels.delete(message.channel);
      channel.onClose(message.closed);
    }
  }

  const send = (message: ToWorker) => port.postMessage(message);

  const transport: Transport = (bench, events): Channel => {
    count += 1;
    const channel = count;
    const kept = { ...events, isOpen: false };
    channels.set(channel, kept);
    send({ channel, open: bench });
    return {
      get isOpen() {
        return kept.isOpen;
      },
      send: (text) => send({ channel, text }),
      close: () => {
        kept.isOpen = false;
        channels.delete(channel);
        send({ channel, close: true });
      },
    };
  };

  const reach = async (request: Request): Promise<Response> => {
    count += 1;
    const ask = count;
    const text = await request.text();
    const { pathname, search } = new URL(request.url);
    const path = pathname.replace(API, "");
    const answer = new Promise<Response>((resolve) => asked.set(ask, resolve));
    send({ ask, method: request.method, path, query: search, body: text ? JSON.parse(text) : {} });
    return answer;
  };

  return { transport, reach };
}
