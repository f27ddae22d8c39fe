/**
 * The session of a page that a learning platform shows in a frame, where browsers send no cookie: it is in memory alone,
 * and sent with each call and each stream.
 */
let session = "";

/** Whether the page has its session in memory. */
export const isInFrame = (): boolean => session !== "";

/** Keep the session. */
export const keepSession = (secret: string): void => {
  session = secret;
};

/** The headers of a call besides the cookie. */
export const sessionHeaders = (): Record<string, string> => (session ? { Authorization: `Bearer ${session}` } : {});

/** The subprotocols of a stream that carry the session: a page cannot set a header of a socket. */
export const sessionProtocols = (): string[] => (session ? [`combbench.session.${session}`] : []);
