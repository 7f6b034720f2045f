/* Ends the program at once, from a signal handler or while a thread hangs. */
#ifndef KILN_CMD_EXIT_MESSAGE_H
#define KILN_CMD_EXIT_MESSAGE_H

/* Removes half-written files, writes the line to standard error unless that would block, and ends
 * the program. The line has at most 4096 bytes with its newline. A signal handler may call it, and
 * so may a thread while another one hangs. */
_Noreturn void exit_with_message(const char *line, int code);

#endif
