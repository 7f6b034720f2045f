/* Writes packets of a coded part into its file, and passes them from the file to the clip. */
#ifndef KILN_OUTPUT_PART_PACKETS_H
#define KILN_OUTPUT_PART_PACKETS_H

#include "output/part_file.h"
#include "output/video.h"

struct kiln_part_packets;

/* Opens an encoder whose packets go into a part's file. first: the part is the first of the clip.
 * NULL with the errors of kiln_video_open. */
struct kiln_part_packets *kiln_part_packets_open(const struct kiln_output_params *params,
                                                 bool first, struct kiln_part_out *out,
                                                 struct kiln_error *error);
bool kiln_part_packets_write(struct kiln_part_packets *packets, const struct kiln_picture *picture,
                             struct kiln_error *error);
bool kiln_part_packets_finish(struct kiln_part_packets *packets, struct kiln_error *error);
void kiln_part_packets_close(struct kiln_part_packets **packets);

/* Copies the packets of an open part to a clip (of kiln_video_open), which has the packets of all
 * earlier parts. */
bool kiln_part_packets_pass(struct kiln_part_in *in, void *clip, const struct kiln_caller *caller,
                            struct kiln_error *error);

#endif
