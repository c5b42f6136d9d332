"""What an answer is worth on trials it was not found on.

unseen            fitted points on trials they were not fitted to; elsewhere: values of runs that were held out
gain              what causes gain there
together          trials kept for testing that were looked at with the others
"""
