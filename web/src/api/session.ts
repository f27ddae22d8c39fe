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

/** What a call carries beside the cookie. */
export const sessionHeaders = (): Record<string, string> => (session ? { Authorization: `Bearer ${session}` } : {});

/** What a stream offers to speak beside its protocol: a socket has no header that a page could set. */
export const sessionProtocols = (): string[] => (session ? [`combbench.session.${session}`] : []);
